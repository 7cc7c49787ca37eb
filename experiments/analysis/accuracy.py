"""The suites `accuracy` and `inliers`, beside the paper's tables."""

import numpy as np
import pandas as pd

from . import paper
from .methods import in_order, label
from .plots import BLUE, INK, grid_of, horizontal
from .section import Section, Table
from .shares import by_group, counts, number


def _errors(rows):
    right = rows[rows.success]
    return {**counts(rows), "e_t_mean": right.e_t.mean(),
            "e_r_mean_deg": np.degrees(right.e_r).mean(), "e_s_mean": right.e_s.mean(),
            "rms_median": right.rms.median(), "plane_median": right.rms_to_best_affine.median()}


def _plot(rows):
    right = rows[rows.success]
    datasets = list(dict.fromkeys(right.dataset))
    methods = in_order(right.method)
    figure, axes = grid_of(len(datasets), min(3, len(datasets)),
                           height=0.17 * len(methods) + 0.5, sharex=True, sharey=True)
    for axis, dataset in zip(axes, datasets):
        for place, method in enumerate(methods):
            errors = 1000 * right[(right.dataset == dataset) & (
                right.method == method)].rms_to_best_affine
            axis.plot(errors, np.full(len(errors), place), "o", color=BLUE, markersize=3.5,
                      alpha=0.4, markeredgewidth=0)
            axis.plot(errors.median(), place, "|", color=INK, markersize=11, markeredgewidth=1.6)
        axis.set_title(dataset)
        horizontal(axis)
    axes[0].set_yticks(range(len(methods)), [label(method) for method in methods])
    axes[0].set_ylim(len(methods) - 0.4, -0.6)
    axes[0].set_xlim(left=0)
    figure.supxlabel("horizontal RMS to the best affine [mm]", fontsize=9)
    return figure


def section(rows):
    """Nothing without rows of the suite `accuracy`."""
    rows = rows[rows.suite == "accuracy"]
    if not rows.success.any():
        return None
    table = by_group(rows, ["kind", "dataset", "guess_scale", "method"], _errors)
    table["paper_real_data"] = [
        paper.text("err_statistic", line.method, line.dataset, line.guess_scale)
        for line in table.itertuples()]
    return Section("accuracy", {"accuracy-methods": _plot(rows)}, [Table("accuracy", table)])


def _matches(rows):
    line = {"pairs": int((rows.matches > 0).sum())}
    for prefix in ("matches", "rematches"):
        matched = rows[rows[prefix] > 0]
        line[prefix] = matched[prefix].mean()
        for what in ("right", "coherent"):
            share = 100 * matched[f"{prefix}_{what}"] / matched[prefix]
            line[f"{prefix}_{what}"], line[f"{prefix}_{what}_deviation"] = share.mean(), share.std()
    return line


def _spread(mean, deviation):
    return number(mean, 1) + ("" if pd.isna(deviation) else f" ± {deviation:.1f}")


def inlier_section(rows):
    """Nothing without rows of the suite `inliers`."""
    rows = rows[(rows.suite == "inliers") & (rows.matches > 0)]
    if rows.empty:
        return None
    order = (list(dict.fromkeys(rows.dataset)), in_order(rows.method))
    table = by_group(rows, ["kind", "dataset", "method"], _matches)
    table = table.sort_values(["dataset", "method"], key=lambda names: names.map(
        order[names.name == "method"].index))
    table["paper_real_data"] = [paper.text("inliers_percentage", line.method, line.dataset)
                                for line in table.itertuples()]
    chain = table[table.method == "paper"]
    shown = pd.DataFrame({
        "data set": chain.dataset, "pairs": chain.pairs,
        "matches": [number(v, 0) for v in chain.matches],
        **{f"{title} [%]": list(map(_spread, chain[column], chain[f"{column}_deviation"]))
           for title, column in (("right", "matches_right"), ("coherent", "matches_coherent"),
                                 ("right, again", "rematches_right"),
                                 ("coherent, again", "rematches_coherent"))},
        "paper [%]": chain.paper_real_data})
    return Section("inliers", {}, [Table("inliers", table, shown)])
