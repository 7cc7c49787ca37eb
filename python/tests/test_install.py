"""What ``cmake --install`` puts down works where it lies, and is a component of its own."""

import os
import subprocess
import sys
from pathlib import Path

BUILD = Path(os.environ["AGRICOLMAP_BUILD"])


def test_the_installed_package_finds_its_library():
    installed = BUILD / "tests/installed"
    (package,) = installed.glob("lib/python3*/dist-packages")
    script = "import agricolmap, agricolmap._core as c; print(agricolmap.__version__, c.__file__)"
    ran = subprocess.run(
        [sys.executable, "-B", "-c", script],
        capture_output=True,
        text=True,
        check=True,
        env={"PYTHONPATH": str(package), "PATH": "/usr/bin"},
    )
    version, file = ran.stdout.split()
    assert version and file.startswith(str(installed))
    linked = subprocess.run(["ldd", file], capture_output=True, text=True, check=True).stdout
    assert "installed" in next(line for line in linked.splitlines() if "libagricolmap.so" in line)


def test_the_component_has_the_package_and_nothing_else(tmp_path):
    subprocess.run(
        ["cmake", "--install", BUILD, "--prefix", tmp_path, "--component", "python"],
        capture_output=True,
        check=True,
    )
    files = [file for file in (tmp_path / "lib").rglob("*") if file.is_file()]
    documents = sorted(file.name for file in (tmp_path / "share").rglob("*") if file.is_file())
    assert documents == ["changelog.gz", "copyright"]
    assert files and all(file.parent.name == "agricolmap" for file in files)
    names = {file.name.split(".")[0] for file in files}
    assert {"__init__", "_core", "py"} <= names
