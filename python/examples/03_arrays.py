"""Points that never were in a file: NumPy arrays in, NumPy arrays out.

Of Open3D: ``numpy.asarray(cloud.points)`` and ``(255 * numpy.asarray(cloud.colors)).round()
.astype(numpy.uint8)``; of laspy: ``las.xyz`` and the 16-bit colours ``// 257``.
"""

import sys

import agricolmap
import numpy as np

if len(sys.argv) != 4:
    sys.exit("usage: 03_arrays.py DRONE ROBOT GUESS")
guess = agricolmap.read_matrix(sys.argv[3])
drone = agricolmap.read(sys.argv[1])
robot = agricolmap.read(sys.argv[2])

# As from a driver: coordinates N×3 in metres, colours N×3 as uint8.
xyz, colours = robot.xyz, robot.colours
tall = xyz[:, 2] > np.median(xyz[:, 2])
print(f"{tall.sum()} of {len(xyz)} points above the middle")

result = agricolmap.register(drone, (xyz, colours), guess)
print(result)
if not result.accepted:
    sys.exit(1)
places = result.place(xyz[tall])  # transformation, and deformation where there is one
print("my first tall point lies at", places[0], "in the drone's map")
laid = agricolmap.Cloud(places, colours[tall], name="tall", crs=drone.crs)
laid.write("tall.las")
