"""One map of a drone's cloud and the strips of several robots, and what stands on the field."""

import sys

import agricolmap
import numpy as np

if len(sys.argv) < 3:
    sys.exit("usage: 06_one_map_of_all.py DRONE ROBOT...")
drone = agricolmap.read(sys.argv[1])

strips = []
for number, robot in enumerate(sys.argv[2:], 1):
    cloud = agricolmap.read(robot)
    result = agricolmap.register(drone, cloud)
    print(f"{robot}: {result.status}")
    if result.accepted:
        strips.append(agricolmap.Strip.of(f"strip {number}", cloud, result))

field = agricolmap.fuse(drone, strips)
for strip in field.strips:
    print(f"{strip.name}: has {strip.owned_m2:.1f} of the {strip.seen_m2:.1f} m² that it saw")
print(f"plants are up to {100 * np.nanquantile(field.plant_height_m, 0.99):.0f} cm high")

# A strip shows single plants; the whole map has coarser cells.
facts = agricolmap.facts(strips[0].cloud)
print(f"{len(facts.rows)} rows {facts.row_spacing_m:.2f} m apart, {facts.total.cover:.0%} green")
if facts.countable:
    print(f"{facts.total.counted} plants, {facts.plant_spacing_m:.2f} m apart")
for place, length in zip(facts.gaps.place_m, facts.gaps.to_m - facts.gaps.from_m):
    print(f"a gap of {length:.2f} m at {place[0]:.2f} {place[1]:.2f}")
