"""The examples run, each in a folder of its own."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parent.parent / "examples"
ARGUMENTS = {
    "01_register.py": ["georeferenced"],
    "02_options_and_verdict.py": ["same_field", "prior.txt"],
    "03_arrays.py": ["same_field", "prior.txt"],
    "04_progress_and_stop.py": ["georeferenced"],
    "05_maps_and_pictures.py": ["georeferenced"],
    "06_one_map_of_all.py": ["georeferenced"],
    "07_walk_through.py": ["same_field", "prior.txt"],
}


def run(name, pairs, folder):
    pair, *files = ARGUMENTS[name]
    clouds = [pairs / pair / "uav/point_cloud.ply", pairs / pair / "ugv/point_cloud.ply"]
    return subprocess.run(
        [sys.executable, "-B", EXAMPLES / name, *clouds, *(pairs / pair / file for file in files)],
        capture_output=True,
        text=True,
        cwd=folder,
    )


def test_every_example_is_run():
    assert sorted(ARGUMENTS) == sorted(file.name for file in EXAMPLES.glob("*.py"))


@pytest.mark.parametrize("name", sorted(ARGUMENTS))
def test_examples_run(name, pairs, tmp_path):
    if name.startswith("05"):
        pytest.importorskip("agricolmap._pictures", reason="a build without pictures")
    if name.startswith("07"):
        pytest.importorskip("matplotlib", reason="the walk through draws with matplotlib")
    ran = run(name, pairs, tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert "accepted" in ran.stdout or name.startswith(("03", "04"))
    assert not ran.stderr


def test_examples_say_how_they_are_called(tmp_path):
    drawing = importlib.util.find_spec("matplotlib") is not None
    for file in EXAMPLES.glob("*.py"):
        if file.name.startswith("07") and not drawing:
            continue
        ran = subprocess.run(
            [sys.executable, "-B", file], capture_output=True, text=True, cwd=tmp_path
        )
        assert ran.returncode != 0 and f"usage: {file.name}" in ran.stderr, file.name
