"""Registers a robot's cloud into a drone's, both in nearly the same coordinates."""

import sys

import agricolmap

if len(sys.argv) != 3:
    sys.exit("usage: 01_register.py DRONE ROBOT")
drone, robot = sys.argv[1:]

result = agricolmap.register(drone, robot)
print(result)
if not result.accepted:
    sys.exit(1)
agricolmap.write_matrix("transform.txt", result.transform)
result.aligned(robot).write("aligned.ply")
