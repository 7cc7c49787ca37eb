"""How plots look, and the kinds of plots that sections share.

Plots are SVG files whose colours follow the reader's light or dark setting.
"""

import io
import re

import matplotlib
from matplotlib.figure import Figure

# Stand-ins that `to_svg` turns into the reader's colours.
_INK, _FAINT, _GROUND = "#010203", "#040506", "#070809"
_STYLE = """<style>
 svg { --ink: #1f2328; --faint: #d1d9e0; --ground: #ffffff; background: var(--ground) }
 @media (prefers-color-scheme: dark) {
  svg { --ink: #e6edf3; --faint: #3d444d; --ground: #0d1117 }
 }
</style>
"""
BLUE, ORANGE, GREEN, RED, PURPLE, GREY, TEAL = (
    "#3182ce", "#dd8a1d", "#2f9e6f", "#d64550", "#8e6bbf", "#8a929a", "#19a7b5")
CYCLE = (BLUE, ORANGE, GREEN, PURPLE, RED, GREY, TEAL)

matplotlib.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "agricolmap", "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "sans-serif"], "font.size": 9, "axes.titlesize": 9.5,
    "axes.titleweight": "bold", "axes.spines.top": False, "axes.spines.right": False,
    "text.color": _INK, "axes.labelcolor": _INK, "axes.edgecolor": _INK, "axes.titlecolor": _INK,
    "xtick.color": _INK, "ytick.color": _INK, "axes.grid": True, "axes.grid.axis": "y",
    "grid.color": _FAINT, "grid.linewidth": 0.7, "axes.axisbelow": True, "lines.linewidth": 1.6,
    "axes.facecolor": "none", "figure.facecolor": "none", "legend.frameon": False,
    "axes.prop_cycle": matplotlib.cycler(color=CYCLE)})
INK, GROUND = _INK, _GROUND


def to_svg(figure):
    """The same bytes for the same figure."""
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None}, transparent=True)
    svg = text.getvalue()
    for stand_in, variable in ((_INK, "--ink"), (_FAINT, "--faint"), (_GROUND, "--ground")):
        svg = svg.replace(stand_in, f"var({variable})")
    svg = re.sub(r"(\.\d\d)\d+", r"\1", svg)  # more digits only make it larger
    return re.sub(r"(<svg[^>]*>\n)", lambda head: head[0] + _STYLE, svg, count=1)


def grid_of(count, columns, width=10.0, height=2.1, **options):
    """A figure with `count` panels, the rest of its last row left free."""
    rows = -(-count // columns)
    figure = Figure(figsize=(width, rows * height + 0.7), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, **options).flat
    for axis in axes[count:]:
        axis.set_visible(False)
    return figure, axes[:count]


def legend_above(figure, handles, labels):
    # As many columns as there is room for, by the longest label.
    fit = int(12 * figure.get_figwidth() / (max(map(len, labels)) + 6))
    columns = max(1, min(len(labels), fit))
    figure.legend(handles, labels, loc="upper center", ncols=columns)
    room = (0.12 + 0.19 * -(-len(labels) // columns)) / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - room))


def share_axis(axis, label=None):
    axis.set_ylim(-0.04, 1.06)
    axis.set_yticks([0, 0.5, 1], ["0", "50 %", "100 %"])
    if label:
        axis.set_ylabel(label)


def horizontal(axis):
    """Of lines below each other: the grid stands upright."""
    axis.grid(True, axis="x")
    axis.grid(False, axis="y")
