"""A registration beside other work: it says how far it is, and stops when it is told to."""

import sys
import threading

import agricolmap

if len(sys.argv) != 3:
    sys.exit("usage: 04_progress_and_stop.py DRONE ROBOT")
drone, robot = map(agricolmap.read, sys.argv[1:])

result = agricolmap.register(drone, robot, progress=lambda stage: print(stage, "..."))
for stage, seconds in result.times.items():
    print(f"{stage}: {seconds:.2f} s")

# Any thread may ask; Ctrl-C does, too, and is a KeyboardInterrupt.
stop = threading.Event()
worker = threading.Timer(0.1, stop.set)
worker.start()
try:
    agricolmap.register(drone, robot, stop=stop)
except agricolmap.Interrupted:
    print("stopped")
worker.join()
