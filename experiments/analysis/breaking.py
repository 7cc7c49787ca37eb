"""The suite `curves`: one setting varied at a time until it breaks."""

import pandas as pd

from .cases import kind_of
from .plots import BLUE, GREY, RED, grid_of, legend_above, share_axis
from .section import Section, Table
from .shares import by_group, counts, percent

# Series by the name in its cases: what is shown, as offset + factor * setting, and with which axis.
_SERIES = {
    "length": ("length of the strip [m]", 0, 1),
    "overhang": ("part of the strip on the map [%]", 100, -100),
    "gaps": ("plants missing [%]", 0, 100),
    "plant-size": ("size of plants, of the usual", 0, 1),
    "leaf-unshared": ("leaf texture not shared [%]", 0, 100),
    "growth": ("growth between the views", 0, 1),
    "drift": ("drift, of the strip's length [%]", 0, 100),
}


def _series_of(case, dataset):
    return kind_of(case.split("=")[0], dataset).removeprefix("curve-")


def _bars(axis, line):
    """Shares that make up a whole, a bar for each value."""
    places = range(len(line))
    bottom = 0.0
    for column, colour, label in (("successes", BLUE, "accepted and right"),
                                  ("not_accepted", GREY, "not accepted"),
                                  ("wrong_accepted", RED, "accepted and wrong")):
        shares = (line[column] / line.runs).to_numpy()
        axis.bar(places, shares, bottom=bottom, color=colour, label=label, width=0.82)
        bottom = bottom + shares
    axis.set_xticks(places, [f"{x:g}" for x in line.x])
    share_axis(axis)


def section(rows):
    """Nothing without rows of this suite."""
    rows = rows[rows.suite == "curves"]
    if rows.empty:
        return None
    rows = rows.assign(series=[_series_of(a, b) for a, b in zip(rows.case_name, rows.dataset)])
    by = ["dataset", "series", "method", "setting"]
    table = by_group(rows.sort_values(by), by, counts)
    order = [name for name in _SERIES if (table.series == name).any()]
    panels = [(name, dataset) for name in order for dataset in dict.fromkeys(table.dataset)]
    figure, axes = grid_of(len(panels), 4)
    for axis, (name, dataset) in zip(axes, panels):
        line = table[(table.series == name) & (table.dataset == dataset)]
        line = line[line.method == line.method.iloc[0]]
        title, offset, factor = _SERIES[name]
        line = line.assign(x=offset + factor * line.setting).sort_values("x")
        _bars(axis, line)
        axis.set_title(dataset)
        axis.set_xlabel(title)
    legend_above(figure, *axes[0].get_legend_handles_labels())
    low, high = table.runs.min(), table.runs.max()
    pairs = f"{low}" if low == high else f"{low} to {high}"
    shown = pd.DataFrame({
        "series": table.series, "data set": table.dataset,
        "setting": table.setting.map("{:g}".format), "pairs": table.runs, "accepted and right %": [
            percent(k, n) for k, n in zip(table.successes, table.runs)],
        "wrong": table.wrong_accepted, "not accepted": table.not_accepted})
    return Section("breaking", {"breaking": figure}, [Table("breaking", table, shown)],
                   f"{pairs} pairs a value.")
