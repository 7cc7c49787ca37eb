"""What can be set, what can be read off the result, and what can go wrong."""

import sys

import agricolmap
from agricolmap import Options, Prior

if len(sys.argv) != 4:
    sys.exit("usage: 02_options_and_verdict.py DRONE ROBOT GUESS")
drone, robot, guess = sys.argv[1:]

# A good receiver and a compass: what is not possible need not be searched.
options = Options(verdict={"min_probability": 0.9})
options.prior = Prior(translation_m=2.0, heading_deg=5.0, scale=0.1)
print(*Options.describe("verdict.min_probability"))
try:
    options["verdict.min_probabilty"] = 0.9
except agricolmap.UsageError as error:
    print(error)  # with the name that was meant

try:
    result = agricolmap.register(drone, robot, guess, options)
except agricolmap.InputError as error:
    sys.exit(f"these clouds cannot be registered: {error}")

print(f"{result.status}, right in the plane with a probability of {result.plane_probability:.3f}")
if result.parts:
    x, y, z = result.parts.shift_m
    print(f"beside the guess: {x:.2f} {y:.2f} {z:.2f} m, {result.parts.heading_deg:.2f} degrees")
if result.uncertainty:
    print(f"expected error {100 * result.uncertainty.expected_rms_m:.1f} cm")
    print("deviation of the heading", result.covariance[3, 3] ** 0.5, "rad")
if result.heights:
    print("heights are", result.heights.words)
print(result.evidence)
for other in result.alternatives:
    print("it fits as well at", other.transform, sep="\n")
for remedy in result.remedies:
    print("what may help:", remedy)
sys.exit(not result.accepted)
