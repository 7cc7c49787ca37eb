"""Types and documents: everything that there is has both."""

import ast
import dataclasses
import importlib
import importlib.util
import inspect
import os
import subprocess
import sys
from pathlib import Path

import agricolmap
import pytest

PACKAGE = Path(agricolmap.__file__).parent


def own(names):
    return {name for name in names if not name.startswith("_")}


def names_of(body):
    """Of a module or class in a stub."""
    return own(
        node.name for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef))
    )


@pytest.mark.parametrize("module", ["_batch", "_core", "_gdal", "_pictures"])
def test_stubs_name_what_the_extension_modules_have(module):
    stub = ast.parse((PACKAGE / f"{module}.pyi").read_text())
    if module != "_core" and importlib.util.find_spec(f"agricolmap.{module}") is None:
        pytest.skip("a build without it")
    loaded = importlib.import_module(f"agricolmap.{module}")
    assert names_of(stub.body) == own(dir(loaded))
    for node in stub.body:
        if isinstance(node, ast.ClassDef):
            assert names_of(node.body) == own(dir(getattr(loaded, node.name))), node.name


def test_all_that_is_public_is_listed_and_documented():
    assert set(agricolmap.__all__) == own(
        name for name, value in vars(agricolmap).items() if not inspect.ismodule(value)
    ) | {"__version__"}
    for name in agricolmap.__all__:
        value = getattr(agricolmap, name)
        if not inspect.isroutine(value) and not inspect.isclass(value):
            continue
        assert value.__doc__, name
        if not inspect.isclass(value):
            continue
        for member, what in vars(value).items():
            if not member.startswith("_") and (inspect.isroutine(what) or isinstance(what, property)):
                assert inspect.getdoc(what), f"{name}.{member}"


def test_attributes_of_results_are_documented():
    for name in agricolmap.__all__:
        value = getattr(agricolmap, name)
        if not dataclasses.is_dataclass(value):
            continue
        for field in dataclasses.fields(value):
            assert field.name.startswith("_") or field.name in value.__doc__, f"{name}.{field.name}"


def test_all_of_the_package_is_typed():
    assert (PACKAGE / "py.typed").exists()
    for file in PACKAGE.glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.FunctionDef):
                assert node.returns is not None, f"{file.name}: {node.name}"


def run_mypy(*arguments):
    pytest.importorskip("mypy", reason="mypy is not installed (scripts/install-dependencies --lint)")
    return subprocess.run(
        [sys.executable, "-m", *arguments],
        capture_output=True,
        text=True,
        env={**os.environ, "MYPYPATH": str(PACKAGE.parent)},
        cwd=PACKAGE.parent,
    )


def test_mypy_is_content(tmp_path):
    checked = run_mypy("mypy", "--strict", "--cache-dir", str(tmp_path), "-p", "agricolmap")
    assert checked.returncode == 0, checked.stdout


def test_stubtest_is_content(tmp_path):
    # pybind11's metaclass, and constructors of classes that cannot be constructed.
    (tmp_path / "allowed").write_text(r"agricolmap\._core\.[A-Za-z]+(\.__init__)?" + "\n")
    modules = [f"agricolmap.{file.stem}" for file in PACKAGE.glob("_*.pyi")]
    checked = run_mypy(
        "mypy.stubtest", "--allowlist", str(tmp_path / "allowed"), "--ignore-unused-allowlist",
        *modules,
    )  # fmt: skip
    assert checked.returncode == 0, checked.stdout
