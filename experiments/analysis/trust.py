"""Whether what the program states of its answers holds: probability and error ellipse."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.stats import chi2

from .plots import BLUE, GREY, INK, ORANGE, share_axis
from .probability import quality, reliability, right as is_right
from .section import Section, Table
from .shares import percent, wilson

# Columns of squared Mahalanobis distances, their degrees of freedom and what they are of.
ELLIPSES = (("pose_mahalanobis2", 5, "five horizontal parameters", BLUE),
             ("centre_mahalanobis2", 2, "the strip's centre", ORANGE),
             ("height_mahalanobis2", 1, "mean height", GREY))


def _square(note):
    figure = Figure(figsize=(5.2, 4.2), layout="constrained")
    axis = figure.subplots()
    axis.plot([0, 1], [0, 1], "--", color=INK, linewidth=0.9, label="ideal")
    share_axis(axis)
    for set_ticks in (axis.set_xticks, axis.set_yticks):
        set_ticks([0, 0.25, 0.5, 0.75, 1], ["0", "25 %", "50 %", "75 %", "100 %"])
    axis.grid(True, axis="both")
    axis.set_title(note)
    return figure, axis


def _reliability_plot(bins, answers):
    figure, axis = _square(f"{answers} answers")
    axis.errorbar(bins.mean_probability, bins.right / bins.answers,
                  yerr=[bins.right / bins.answers - bins.right_low,
                        bins.right_high - bins.right / bins.answers],
                  fmt="o-", color=BLUE, capsize=2, markersize=4, label="what came true")
    for _, one in bins.iterrows():
        axis.annotate(f"{one.answers:.0f}", (one.mean_probability, one.right / one.answers),
                      xytext=(5, -11), textcoords="offset points", fontsize=7.5)
    axis.set_xlabel("stated probability")
    axis.set_ylabel("answers that are right")
    axis.legend(loc="upper left")
    return figure


def _coverage(rows):
    nominal = np.arange(0, 1.0001, 0.05)
    table = []
    for column, degrees, name, _ in ELLIPSES:
        below = chi2.cdf(rows[column].dropna(), degrees)
        for limit in nominal if len(below) else []:
            hits = int((below <= limit + 1e-12).sum())
            low, high = wilson(hits, len(below))
            table.append({"of": name, "stated": round(limit, 2), "answers": len(below),
                          "inside": hits, "low": low, "high": high})
    return pd.DataFrame(table, columns=["of", "stated", "answers", "inside", "low", "high"])


def _coverage_plot(table, answers):
    figure, axis = _square(f"{answers} accepted and right")
    for _, _, name, colour in ELLIPSES:
        line = table[table.of == name]
        if line.empty:
            continue
        axis.plot(line.stated, line.inside / line.answers, color=colour, label=name)
        axis.fill_between(line.stated, line.low, line.high, color=colour, alpha=0.15, linewidth=0)
    axis.set_xlabel("stated ellipse")
    axis.set_ylabel("true errors inside")
    axis.legend(loc="upper left")
    return figure


def section(rows):
    """Nothing without rows that state a probability."""
    # Heights included in rows of earlier sources, which say so in a column of their own.
    with_heights = rows.probability.notna().any()
    stated = rows[(rows.probability if with_heights else rows.plane_probability).notna()]
    if stated.empty:
        return None
    right = is_right(stated, plane=not with_heights)
    probability = stated.probability if with_heights else stated.plane_probability
    bins = reliability(probability.to_numpy(), right)
    worth = quality(probability, right)
    facts = ("{answers} answers state a probability: expected calibration error "
             "{calibration_error_equal_width:.4f} in ten bins of equal width, "
             "{calibration_error_equal_mass:.4f} in ten of equal number; area under the curve "
             "{area_under_curve:.4f}.").format(**worth)
    shown = pd.DataFrame({
        "stated": [f"{a:.1f}–{b:.1f}" for a, b in zip(bins.low, bins.high)],
        "answers": bins.answers, "mean": bins.mean_probability.map("{:.3f}".format),
        "right %": [percent(r, n) for r, n in zip(bins.right, bins.answers)]})
    plots = {"reliability": _reliability_plot(bins, len(stated))}
    tables = [Table("reliability", bins, shown)]
    successes = rows[rows.success]
    covered = _coverage(successes)
    if len(covered):
        plots["coverage"] = _coverage_plot(covered, len(successes))
        at = covered[covered.stated == 0.9]
        shown = pd.DataFrame({"of": at.of, "answers": at.answers, "inside the 90 % ellipse %": [
            percent(k, n) for k, n in zip(at.inside, at.answers)]})
        tables.append(Table("coverage", covered, shown))
    return Section("trust", plots, tables, facts)
