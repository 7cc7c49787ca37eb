"""Simulated pairs of clouds, and registrations that several tests look at."""

import os
import subprocess
from pathlib import Path

import agricolmap
import numpy as np
import pytest


@pytest.fixture(scope="session")
def pairs() -> Path:
    """Folders as ``agricolmap simulate`` makes them: uav, ugv, prior.txt, truth.txt."""
    return Path(os.environ["AGRICOLMAP_PAIRS"])


@pytest.fixture(scope="session")
def drone(pairs):
    return agricolmap.read(pairs / "same_field/uav/point_cloud.ply")


@pytest.fixture(scope="session")
def robot(pairs):
    return agricolmap.read(pairs / "same_field/ugv/point_cloud.ply")


@pytest.fixture(scope="session")
def guess(pairs):
    return agricolmap.read_matrix(pairs / "same_field/prior.txt")


@pytest.fixture(scope="session")
def result(drone, robot, guess):
    """An accepted registration."""
    return agricolmap.register(drone, robot, guess)


@pytest.fixture(scope="session")
def program():
    """Runs the program."""

    def run(*words):
        subprocess.run(
            [os.environ["AGRICOLMAP_PROGRAM"], *map(str, words)], check=True, capture_output=True
        )

    return run


@pytest.fixture(scope="session")
def folders(pairs, program, tmp_path_factory):
    """Two maps of one drone's cloud as the program writes them, of two strips and of a third."""
    pytest.importorskip("agricolmap._gdal", reason="a build without GDAL")
    place = tmp_path_factory.mktemp("maps")
    drone = pairs / "strips/uav/point_cloud.ply"
    for name, numbers in (("before", (1, 2)), ("after", (3,))):
        strips = [pairs / f"runs/strip_{number}" for number in numbers]
        program("fuse", drone, *strips, "-o", place / name, "--no-pictures")
    return place / "before", place / "after"


@pytest.fixture
def flat():
    """A square metre of points at 1 cm, of two colours, far from zero: xyz, colours."""
    col, row = np.meshgrid(np.arange(100), np.arange(100))
    xyz = np.column_stack(
        [500000 + 0.01 * col.ravel(), 5000000 + 0.01 * row.ravel(), np.full(col.size, 80.0)]
    )
    colours = np.where((col.ravel() < 50)[:, None], [20, 200, 20], [100, 90, 80]).astype(np.uint8)
    return xyz, colours
