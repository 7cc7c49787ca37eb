"""Simulated pairs of clouds, and registrations that several tests look at."""

import os
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


@pytest.fixture
def flat():
    """A square metre of points at 1 cm, of two colours, far from zero: xyz, colours."""
    col, row = np.meshgrid(np.arange(100), np.arange(100))
    xyz = np.column_stack(
        [500000 + 0.01 * col.ravel(), 5000000 + 0.01 * row.ravel(), np.full(col.size, 80.0)]
    )
    colours = np.where((col.ravel() < 50)[:, None], [20, 200, 20], [100, 90, 80]).astype(np.uint8)
    return xyz, colours
