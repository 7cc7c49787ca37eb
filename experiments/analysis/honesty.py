"""Whether what is accepted is right and what is stated is true, as tables for the terminal: of pairs
that were made elsewhere (suites `dates`, `mirrored`, `slips`, `other-generator`), and of any others.
"""

import numpy as np
import pandas as pd
from scipy.stats import chi2

from . import heights
from .cases import kind_of, without_single
from .probability import quality
from .rows import CENTRE
from .shares import by_group, number, percent
from .trust import ELLIPSES

# Horizontal RMS over the strip, to the truth [m]: right; right of what is two weeks apart; a place
# beyond doubt.
RIGHT, NEARLY, FAR = 0.05, 0.08, 0.24
# Of fewer strips of a case nothing is said of what they have in common.
LEAST_STRIPS = 5


def _summary(rows):
    """An accepted answer to a pair without a right place is wrong by any measure."""
    error = rows.rms_horizontal.where(~rows.negative, float("inf"))
    accepted = rows[rows.accepted & ~rows.negative]

    def both(errors):
        return " / ".join(number(errors.quantile(q), 1, 1000) for q in (0.5, 0.95))

    return {
        "n": len(rows), "accepted %": percent(rows.accepted.sum(), len(rows)),
        "and ≤ 5 cm %": percent((rows.accepted & (error <= RIGHT)).sum(), len(rows)),
        "≤ 8 cm %": percent((rows.accepted & (error <= NEARLY)).sum(), len(rows)),
        "found ≤ 5 cm": int((error <= RIGHT).sum()),
        "plane mm": both(accepted.rms_horizontal), "to best": both(accepted.rms_to_best_affine),
        "height mm": both(accepted.rms_vertical),
        "wrong > 5 cm %": percent((rows.accepted & (error > RIGHT)).sum(), len(rows)),
        "> 24 cm": int((rows.accepted & (error > FAR)).sum()),
        "wrong p": number(rows.plane_probability[error > RIGHT].max(), 2)}


def _stated(rows):
    """Of accepted answers, right or not, to pairs that have a right place; the probability's
    calibration over all answers."""
    accepted = rows[rows.accepted & ~rows.negative]
    line = {"accepted": len(accepted)}
    for column, degrees, *_ in ELLIPSES:
        name = column.removesuffix("_mahalanobis2")
        below = chi2.cdf(accepted[column].dropna(), degrees)
        for share in (0.5, 0.9):
            line[f"{name} in {share:.0%}"] = percent((below <= share).sum(), len(below))
    ratio = accepted.rms_horizontal / accepted.expected_rms
    line["true over stated RMS"] = " / ".join(number(ratio.quantile(q), 2) for q in (0.5, 0.9))
    answers = rows[rows.plane_probability.notna()]
    if len(answers):
        worth = quality(answers.plane_probability, ~answers.negative & answers.right_in_plane)
        line.update(answers=len(answers), ECE=number(worth["calibration_error_equal_mass"], 3))
    return line


def _without_common(rows):
    """Of the accepted strips of each case: whether the stated 90 % ellipse has the error of the
    centre once the mean error of the case's other strips is taken off, and that mean. Where the
    truth is a georeference of two flights it has an error that all strips of the pair share; but so
    may the registration have, and that is taken off with it."""
    lines = []
    for case, of in rows[rows.accepted & ~rows.negative].groupby("case_name"):
        of = of[list(CENTRE)].dropna().to_numpy()
        if len(of) < LEAST_STRIPS:
            continue
        error, (sx, sy), rho = of[:, :2], of[:, 2:4].T, of[:, 4]
        others = (error.sum(axis=0) - error) / (len(of) - 1)
        # The others' mean is as uncertain as they scatter.
        rest = (error - others).T * np.sqrt((len(of) - 1) / len(of))
        x, y = rest[0] / sx, rest[1] / sy
        distance2 = (x**2 - 2 * rho * x * y + y**2) / (1 - rho**2)
        mean = 100 * error.mean(axis=0)
        lines.append({"case": case, "strips": len(of),
                      "common x, y cm": f"{mean[0]:.1f}, {mean[1]:.1f}",
                      "inside": int((chi2.cdf(distance2, 2) <= 0.9).sum()),
                      "left over cm RMS": number(np.sqrt((rest**2).sum(axis=0).mean()), 1, 100)})
    if not lines:
        return None
    table = pd.DataFrame(lines)
    strips, inside = table.strips.sum(), table.inside.sum()
    table.loc[len(table)] = ["all", strips, "", inside, ""]
    table["inside the 90 % ellipse"] = [percent(a, b) for a, b in zip(table.inside, table.strips)]
    return table.drop(columns="inside")


def text(rows):
    """Three tables: cases of one kind together, each case, and what is stated; of the suite `dates`
    what is left without what all strips of a pair of dates share, and of `heights` another."""
    rows = rows.assign(
        kind=[kind_of(a, b) for a, b in zip(rows.case_name, rows.dataset)],
        case=rows.case_name)
    tables = [by_group(rows, ["suite", "settings", by, "method"], _summary)
              for by in ("kind", "case")]
    tables.append(by_group(rows, ["suite", "settings", "method"], _stated))
    with pd.option_context("display.width", None, "display.max_columns", None):
        texts = [without_single(table.fillna("–")).to_string(index=False) for table in tables]
        common = _without_common(rows[rows.suite == "dates"])
        if common is not None:
            texts.append(common.to_string(index=False))
        if not heights.of_suite(rows).empty:
            texts.append(heights.text(rows))
        return "\n\n".join(texts)
