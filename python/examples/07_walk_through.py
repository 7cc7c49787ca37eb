"""A walk through the pipeline, drawn with matplotlib: walk.png, for docs/python.md."""

import sys

import agricolmap
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.transforms import Affine2D  # noqa: E402

if len(sys.argv) != 4:
    sys.exit("usage: 07_walk_through.py DRONE ROBOT GUESS")
guess = agricolmap.read_matrix(sys.argv[3])
drone, robot = map(agricolmap.read, sys.argv[1:3])

# Level and grid: each cloud is a map of its own before they meet.
drone_map = agricolmap.map_cloud(drone)
robot_map = agricolmap.map_cloud(robot)

# Signals, locate, refine, heights, deform, judge, compose.
result = agricolmap.register(drone, robot, guess)
print(result)
fixed, moving = result.maps()

origin = fixed.centres()[0].min(), fixed.centres()[1].min()


def draw(axes, cells, values, **how):
    """The cells where they lie, whatever way they are turned; metres from the map's corner."""
    a, b, c, d, e, f = cells.affine
    place = Affine2D(np.array([[a, b, c - origin[0]], [d, e, f - origin[1]], [0, 0, 1]]))
    rows, columns = cells.shape
    axes.imshow(
        values,
        extent=(0, columns, 0, rows),
        origin="lower",
        transform=place + axes.transData,
        **how,
    )


def outline(axes, transform, colour, name):
    """Where the transformation lays the strip's corners."""
    rows, columns = robot_map.shape
    corners = np.array([[0, 0], [columns, 0], [columns, rows], [0, rows], [0, 0]], float)
    cells = np.column_stack([corners, np.zeros(5), np.ones(5)])
    laid = cells @ (transform @ robot_map.file_from_cell).T
    axes.plot(laid[:, 0] - origin[0], laid[:, 1] - origin[1], color=colour, lw=2, label=name)


figure, axes = plt.subplots(1, 3, figsize=(15, 5.4), layout="constrained")
axes[0].imshow(robot_map.north_up().colour)
axes[0].set_title("the robot's strip, levelled and drawn as cells")
axes[0].set_axis_off()
green = {"vmin": -0.1, "vmax": 0.6, "cmap": "YlGn"}
draw(axes[1], fixed, fixed.excess_green, **green)
outline(axes[1], guess, "tab:orange", "as the guess lays it")
outline(axes[1], result.transform, "tab:blue", "as the registration does")
axes[1].set_title("Excess Green of the drone's map")
axes[1].legend(loc="upper right")
draw(axes[2], fixed, fixed.excess_green, **green)
draw(axes[2], moving, moving.excess_green, vmin=-0.1, vmax=0.6, cmap="RdPu")
x, y = moving.centres()
for side in axes[1:]:
    side.set_aspect("equal")
    side.set_xlim(0, fixed.shape[1] * fixed.cell_m)
    side.set_ylim(0, fixed.shape[0] * fixed.cell_m)
    side.set_xlabel("m")
axes[2].set_xlim(x.min() - origin[0] - 0.5, x.min() - origin[0] + 3.5)
axes[2].set_ylim(y.mean() - origin[1] - 2, y.mean() - origin[1] + 2)
axes[2].set_title("the strip's (magenta) where it was laid: rows go on")
figure.savefig("walk.png", dpi=100)
sys.exit(not result.accepted)
