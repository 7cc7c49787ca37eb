"""Heights and their own verdict, of the suite `heights`: how far off, how often limited, and whether
the stated deviation holds."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from .plots import BLUE, INK, ORANGE
from .section import Section, Table
from .shares import by_group, number, percent

# What measured heights should reach [m]. Hard views grow, are blown about and are seen from lower.
LIMITS = {"fair": 0.03, "hard": 0.05}


def of_suite(rows):
    """Accepted answers of the suite, with the kind of view and the crop."""
    chosen = rows[(rows.suite == "heights") & rows.accepted & rows.height_error.notna()]
    return chosen.assign(view=["fair" if "heights-fair-" in name else "hard"
                               for name in chosen.case_name],
                         crop=chosen.case_name.str.replace(
                             r"^.*heights-(fair|hard)-", "", regex=True),
                         error=chosen.height_error.abs())


def summary(rows):
    limit = LIMITS[rows.view.iloc[0]]
    measured = rows[rows.heights_limited == 0]
    inside = rows.error <= 2 * rows.height_deviation
    return {
        "accepted": len(rows),
        "limited %": percent(int((rows.heights_limited == 1).sum()), len(rows)),
        "measured within": f"{(measured.error <= limit).sum()} of {len(measured)} "
                           f"({100 * limit:.0f} cm)",
        "median mm": number(measured.error.median(), 0, 1000),
        "worst mm": number(measured.error.max(), 0, 1000),
        "stated mm": number(measured.height_deviation.median(), 0, 1000),
        "worst limited mm": number(rows[rows.heights_limited == 1].error.max(), 0, 1000),
        "inside 2 deviations %": percent(int(inside.sum()), len(rows))}


def table(rows):
    """By view and crop, then by view."""
    chosen = of_suite(rows)
    columns = ["settings", "view", "crop", "method"]
    return pd.concat([by_group(chosen, columns, summary),
                      by_group(chosen.assign(crop="all"), columns, summary)], ignore_index=True)


def _plot(chosen):
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axis = figure.subplots()
    top = 105 * max(chosen.error.max(), 2 * chosen.height_deviation.min())
    stated = np.array([0.0, 100 * chosen.height_deviation.max() * 1.05])
    axis.plot(stated, 2 * stated, "--", color=INK, linewidth=0.9, label="2 deviations")
    for limited, view, colour, marker in ((0, "fair", BLUE, "o"), (0, "hard", BLUE, "^"),
                                          (1, "fair", ORANGE, "o"), (1, "hard", ORANGE, "^")):
        of = chosen[(chosen.heights_limited == limited) & (chosen.view == view)]
        if len(of):
            axis.plot(100 * of.height_deviation, 100 * of.error, marker, color=colour,
                      markersize=5, alpha=0.8, linestyle="none",
                      label=f"{'limited' if limited else 'measured'}, {view} ({len(of)})")
    axis.set_ylim(0, top)
    axis.set_xlim(0, stated[1])
    axis.set_xlabel("stated deviation of the height [cm]")
    axis.set_ylabel("true error [cm]")
    axis.grid(True, axis="both")
    axis.legend(loc="upper left")
    return figure


def section(rows):
    """Nothing without rows of the suite."""
    chosen = of_suite(rows)
    if chosen.empty:
        return None
    made = table(rows)
    return Section("heights", {"heights": _plot(chosen)},
                   [Table("heights", made, made.drop(columns=["settings", "method"]))])


def text(rows):
    made = table(rows)
    return "" if made.empty else made.to_string(index=False)
