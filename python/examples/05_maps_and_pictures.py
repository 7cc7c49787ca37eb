"""The report and pictures of the command line, and the maps themselves as arrays.

For rasterio, of ``up = fixed.north_up()``: ``rasterio.open(name, "w", driver="GTiff", width=
up.shape[1], height=up.shape[0], count=1, dtype="float32", crs=up.crs.wkt, nodata=float("nan"),
transform=affine.Affine(*up.affine))`` and ``.write(up.height_m, 1)``. For xarray: ``xarray.DataArray
(fixed.height_m, dims=("row", "column"))`` with ``fixed.centres()`` as its coordinates.
"""

import sys

import agricolmap
import numpy as np

if len(sys.argv) != 3:
    sys.exit("usage: 05_maps_and_pictures.py DRONE ROBOT")

result = agricolmap.register(*sys.argv[1:])
print(result)
for name in result.write_report("report"):
    print("report/" + name)

fixed, moving = result.maps()
x, y = moving.centres()
seen = ~np.isnan(moving.height_m)
cells = np.floor(fixed.cells_of(np.column_stack([x[seen], y[seen]]))).astype(int)
inside = ((cells >= 0) & (cells < fixed.shape[::-1])).all(axis=1)
column, row = cells[inside].T
higher = moving.height_m[seen][inside] - fixed.height_m[row, column]
print(f"the robot's surface lies {100 * np.nanmedian(higher):+.1f} cm above the drone's")
sys.exit(not result.accepted)
