"""Whether what is accepted is right and what is stated is true, as tables for the terminal: of pairs
that were made elsewhere (suites `dates`, `mirrored`, `slips`, `other-generator`), and of any others.
"""

import pandas as pd
from scipy.stats import chi2

from . import heights
from .cases import kind_of, without_single
from .probability import quality
from .shares import by_group, number, percent
from .trust import ELLIPSES

# Horizontal RMS over the strip, to the truth [m]: right; right of what is two weeks apart; a place
# beyond doubt.
RIGHT, NEARLY, FAR = 0.05, 0.08, 0.24


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


def text(rows):
    """Three tables: cases of one kind together, each case, and what is stated; and of the suite
    `heights` a fourth."""
    rows = rows.assign(
        kind=[kind_of(a, b) for a, b in zip(rows.case_name, rows.dataset)],
        case=rows.case_name)
    tables = [by_group(rows, ["suite", "settings", by, "method"], _summary)
              for by in ("kind", "case")]
    tables.append(by_group(rows, ["suite", "settings", "method"], _stated))
    with pd.option_context("display.width", None, "display.max_columns", None):
        texts = [without_single(table.fillna("–")).to_string(index=False) for table in tables]
        if not heights.of_suite(rows).empty:
            texts.append(heights.text(rows))
        return "\n\n".join(texts)
