"""Success over the error of the guess: the suites translation, heading, accuracy and joint."""

import pandas as pd

from . import paper
from .methods import in_order, label
from .plots import BLUE, GREEN, INK, ORANGE, RED, grid_of, legend_above, share_axis
from .section import Section, Table
from .shares import by_group, counts, number

SUITES = ("translation", "heading", "joint", "accuracy")
# Largest errors that the paper tries.
_PAPER_RANGE = {"translation": 5.0, "heading": 0.2}
_AXES = {"translation": "error of position [m]", "heading": "error of heading [rad]",
         "accuracy": "error of scale [%]"}
_COLOURS = {0.0: BLUE, 0.1: GREEN, 0.2: ORANGE, 0.3: RED}


def _pairs(rows):
    return len(rows[["case_name", "seed"]].drop_duplicates())


def _curve(axis, rows, places, scale, aside):
    """Settings stand at equal distances, lines aside of each other, or equal shares would hide all
    but one."""
    table = by_group(rows, ["setting"], counts).sort_values("setting")
    x = [places[setting] + aside for setting in table.setting]
    colour = _COLOURS.get(scale, RED)
    axis.plot(x, table.success, "o-", markersize=3.2, linewidth=1.1, color=colour,
              label=f"scale {100 * scale:.0f} % off")
    if scale == 0:
        axis.fill_between(x, table.success_low, table.success_high, alpha=0.15, linewidth=0,
                          color=colour)


def _panel(axis, rows, suite, method, places):
    scales = [0.0] if suite == "accuracy" else sorted(rows.guess_scale.unique())
    for i, scale in enumerate(scales):
        line = rows if suite == "accuracy" else rows[rows.guess_scale == scale]
        _curve(axis, line, places, scale, 0.18 * (i - (len(scales) - 1) / 2))
    published = paper.curve(suite, method)
    published = published[published.setting.isin(places)]
    if len(published):
        axis.plot(published.setting.map(places), published.share, "D--", color=INK, linewidth=0.9,
                  markersize=4.5, markerfacecolor="none", label="paper, real data")
    shown = list(places) if len(places) < 9 else list(places)[::3] + [max(places)]
    axis.set_xticks([places[one] for one in shown],
                    [f"{100 * one if suite == 'accuracy' else one:g}" for one in shown])
    share_axis(axis)


def _plot(rows, suite):
    rows = rows[rows.suite == suite]
    places = {setting: i for i, setting in enumerate(sorted(rows.setting.unique()))}
    panels = [(method, kind) for method in in_order(rows.method) for kind in rows.kind.unique()
              if rows[(rows.method == method) & (rows.kind == kind)].setting.nunique() > 1]
    if not panels:
        return None
    figure, axes = grid_of(len(panels), 4, height=1.75)
    entries = {}
    for axis, (method, kind) in zip(axes, panels):
        of = rows[(rows.method == method) & (rows.kind == kind)]
        _panel(axis, of, suite, method, places)
        kind_text = "" if kind == "simulated" else f", {kind}"
        axis.set_title(f"{label(method)}{kind_text} ({_pairs(of)})")
        entries |= dict(zip(*axis.get_legend_handles_labels()[::-1]))
    figure.supxlabel(_AXES[suite], fontsize=9)
    if len(entries) > 1:
        legend_above(figure, entries.values(), entries.keys())
    return figure


def _overview(rows):
    """A line for each method, over all its runs of these suites."""
    inside = rows.setting <= rows.suite.map(_PAPER_RANGE).fillna(float("inf"))
    lines = []
    for method in in_order(rows.method):
        all_of = rows[rows.method == method]
        made = all_of[all_of.status != "skipped"]
        tried = all_of[inside[all_of.index]]
        exact, off = tried[tried.guess_scale == 0].success, tried[tried.guess_scale > 0].success
        right = made[made.success]
        lines.append({
            "method": method, "pairs": _pairs(all_of), "runs": len(made),
            "successes": len(right), "right": int(made.right.sum()),
            "wrong_accepted": int((made.accepted & ~made.right).sum()),
            "inside_runs": len(tried), "inside_successes": int(tried.success.sum()),
            "exact_scale_success": exact.mean(), "wrong_scale_success": off.mean(),
            "plane_median": right.rms_to_best_affine.median(), "rms_median": right.rms.median()})
    full = pd.DataFrame(lines)
    shown = pd.DataFrame({
        "method": full.method, "pairs": full.pairs, "runs": full.runs,
        "accepted and right": full.successes, "accepted and wrong": full.wrong_accepted,
        "right, scale exact": [f"{number(v, 1, 100)} %" for v in full.exact_scale_success],
        "right, scale off": [f"{number(v, 1, 100)} %" for v in full.wrong_scale_success],
        "plane mm": [number(v, 1, 1000) for v in full.plane_median]})
    return Table("methods", full, shown)


def _contests(rows):
    """At each setting and kind, the default preset and each method on the pairs that both were run
    on: some pairs are harder than others."""
    lines = []
    settings = ["kind", "suite", "guess_scale", "setting"]
    for keys, here in rows.groupby(settings, sort=False):
        of = {method: part.set_index(["case_name", "seed"]).success
              for method, part in here.groupby("method")}
        ours = of.pop("default", pd.Series(dtype=bool))
        for method, theirs in of.items():
            both = ours.index.intersection(theirs.index)
            if len(both):
                lines.append({**dict(zip(settings, keys)), "method": method, "pairs": len(both),
                              "default": ours[both].mean(), "other": theirs[both].mean()})
    if not lines:
        return []
    full = pd.DataFrame(lines)
    lead = (full.default - full.other).groupby(full.method)
    shown = pd.DataFrame({"settings of both": lead.size(), "default ahead": lead.agg(
        lambda d: (d > 0).sum()), "level": lead.agg(lambda d: (d == 0).sum()),
        "behind": lead.agg(lambda d: (d < 0).sum())})
    shown = shown.loc[in_order(full.method)].reset_index()
    return [Table("contests", full, shown)]


def section(rows):
    """Nothing without rows of these suites."""
    rows = rows[rows.suite.isin(SUITES)]
    if rows.empty:
        return None
    plots = {f"success-{suite}": _plot(rows, suite) for suite in _AXES}
    plots = {name: figure for name, figure in plots.items() if figure}
    each = by_group(
        rows, ["suite", "kind", "dataset", "guess_scale", "setting", "method"], counts)
    return Section("success", plots,
                   [_overview(rows), *_contests(rows), Table("success", each)])
