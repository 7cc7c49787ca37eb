"""While it works: the interpreter is free, progress is told, and it stops when it is told to."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import agricolmap
import pytest


def test_stages_are_told_from_the_calling_thread(drone, robot, guess):
    stages, threads = [], set()

    def progress(stage):
        stages.append(stage)
        threads.add(threading.get_ident())

    result = agricolmap.register(drone, robot, guess, progress=progress)
    assert stages[:2] == ["level", "grid"] and set(result.times) == set(stages)
    assert threads == {threading.get_ident()}


def test_what_progress_raises_is_raised(drone, robot, guess):
    stages = []

    def progress(stage):
        stages.append(stage)
        if stage == "grid":
            raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        agricolmap.register(drone, robot, guess, progress=progress)
    assert stages == ["level", "grid"]


def test_an_event_stops(drone, robot, guess):
    stop = threading.Event()
    began = time.monotonic()
    with pytest.raises(agricolmap.Interrupted, match="interrupted"):
        agricolmap.register(
            drone, robot, guess, stop=stop, progress=lambda stage: stage == "grid" and stop.set()
        )
    stop.set()
    with pytest.raises(agricolmap.Interrupted):
        agricolmap.register(drone, robot, guess, stop=stop)
    with pytest.raises(agricolmap.Interrupted):
        agricolmap.map_cloud(drone, stop=stop)
    assert time.monotonic() - began < 10


def test_other_threads_run_meanwhile(drone, robot, guess):
    """Two registrations side by side, and a thread that counts."""
    results, counted, done = [], [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.005)

    counter = threading.Thread(target=count)
    counter.start()
    workers = [
        threading.Thread(
            target=lambda: results.append(agricolmap.register(drone, robot, guess).status)
        )
        for _ in range(2)
    ]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    done.set()
    counter.join()
    assert results == [agricolmap.Status.ACCEPTED] * 2
    assert counted[0] > 20


def test_ctrl_c_is_a_keyboard_interrupt(pairs):
    """In a process of its own, in the middle of a search that would take long."""
    script = textwrap.dedent(
        """
        import signal, sys
        signal.signal(signal.SIGINT, signal.default_int_handler)
        import agricolmap
        folder = sys.argv[1]
        try:
            agricolmap.register(
                f"{folder}/uav/point_cloud.ply",
                f"{folder}/ugv/point_cloud.ply",
                f"{folder}/prior.txt",
                {"preset": "paper", "grid.cell": 0.01},
                progress=lambda stage: print(stage, flush=True),
            )
        except KeyboardInterrupt:
            print("stopped")
        """
    )
    process = subprocess.Popen(
        [sys.executable, "-c", script, str(pairs / "same_field")],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ,
    )
    for line in process.stdout:
        if line.strip() == "describe":
            break
    time.sleep(0.3)
    began = time.monotonic()
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=60)
    assert rest.split()[-1] == "stopped" and process.returncode == 0
    assert time.monotonic() - began < 10
