"""Time and memory."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from . import paper
from .methods import in_order, label
from .plots import BLUE, INK, horizontal, legend_above
from .section import Section, Table
from .shares import by_group, number


def computing_seconds(rows):
    """What a run on one thread took, less what other programs on the machine took of its core."""
    share = (rows.cpu_s / rows.wall_s.fillna(rows.run_s)).clip(upper=1.0).fillna(1.0)
    return rows.run_s * share.where(rows.threads == 1, 1.0)


def _stage_shares(rows):
    """The stages' shares of the time, the largest first."""
    parts = rows.stages.str.split(";").explode().str.split("=", expand=True).dropna()
    seconds = parts[1].astype(float).groupby(parts[0]).sum() if parts.shape[1] == 2 else (
        pd.Series(dtype=float))
    return (seconds / seconds.sum()).sort_values(ascending=False, kind="stable")


def _summary(rows):
    right = rows[rows.success]
    return {
        "runs": len(rows), "successes": len(right),
        **right.seconds.agg(["min", "median", "max", "mean"]).add_suffix("_s"),
        "mean_all_s": rows.seconds.mean(), "peak_mib": rows.peak_mib.median(),
        "stages": ";".join(f"{name}={share:.3f}" for name, share in _stage_shares(right).items())}


def _published(method):
    """The paper's smallest, mean and largest seconds; nothing where it has none."""
    text = paper.text("timings_tab", method)
    return [text.split(" / ")[i] for i in (0, 2, 1)] if text else []


def _plot(table):
    table = table[table.successes > 0]
    figure = Figure(figsize=(8.0, 0.24 * len(table) + 1.1), layout="constrained")
    axis = figure.subplots()
    y = np.arange(len(table))
    axis.hlines(y, table.min_s, table.max_s, color=BLUE, linewidth=4, alpha=0.4)
    axis.plot(table.mean_s, y, "o", color=BLUE, label="ours: min, mean, max")
    published = [(place, *map(float, seconds)) for place, seconds in enumerate(
        map(_published, table.method)) if seconds]
    if published:
        place, low, mean, high = np.array(published).T
        axis.hlines(place + 0.28, low, high, color=INK, linewidth=1)
        axis.plot(mean, place + 0.28, "D", color=INK, markersize=4, markerfacecolor="none",
                  label="paper, its machine and data")
    axis.set_yticks(y, [label(method) for method in table.method])
    axis.set_ylim(len(table) - 0.4, -0.6)
    axis.set_xlabel("seconds of a right answer")
    axis.set_xscale("log")
    axis.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axis.xaxis.set_minor_formatter(NullFormatter())
    horizontal(axis)
    legend_above(figure, *axis.get_legend_handles_labels())
    return figure


def section(rows):
    rows = rows[(rows.status != "skipped")]
    rows = rows.assign(seconds=computing_seconds(rows))
    table = by_group(rows, ["method", "threads"], _summary)
    table = table.sort_values("method", key=lambda names: names.map(in_order(rows.method).index))
    shown = pd.DataFrame({
        "method": table.method, "runs": table.runs,
        "min / mean / max s": [" / ".join(number(v, 1) for v in line) for line in zip(
            table.min_s, table.mean_s, table.max_s)],
        "median s": [number(v, 1) for v in table.median_s],
        "paper, min / mean / max s": [" / ".join(_published(method)) or "–"
                                      for method in table.method],
        "peak MiB": [number(v, 0) for v in table.peak_mib],
        "stages": [", ".join(f"{name} {100 * share:.0f} %" for name, share in _stage_shares(
            rows[rows.success & (rows.method == method)])[:4].items()) for method in table.method]})
    return Section("costs", {"times": _plot(table)} if table.successes.any() else {},
                   [Table("times", table, shown)])
