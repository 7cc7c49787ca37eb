"""Options: the library's table, and nothing beside it."""

import os
import subprocess

import agricolmap
import numpy as np
import pytest
from agricolmap import Options, Prior


def test_names_types_and_defaults_are_those_of_the_command_line(tmp_path):
    """What the program dumps, Python reads as its own defaults, and the other way round."""
    dump = subprocess.run(
        [os.environ["AGRICOLMAP_PROGRAM"], "register", "--dump-config"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    (tmp_path / "program.yaml").write_text(dump)
    Options().save(tmp_path / "python.yaml")
    assert (tmp_path / "python.yaml").read_text() == dump
    assert Options.load(tmp_path / "program.yaml") == Options()


def test_every_option_is_described():
    infos = Options.describe()
    assert [info.name for info in infos] == Options.names() == list(Options())
    assert len(infos) == len(Options()) > 100
    options = Options()
    for info in infos:
        assert type(options[info.name]) is info.type and options[info.name] == info.default
        assert info.help and info.limits
        options[info.name] = info.default
        if info.type in (int, float):
            assert info.low <= info.default <= info.high
        if info.type is str:
            assert info.default in info.choices
    assert [info.name for info in Options.describe("grid")][:2] == ["grid.cell", "grid.sigma"]
    (cell,) = Options.describe("grid.cell")
    assert str(cell).startswith("grid.cell = 0.02 m (0.005 to 1 m): ") and cell.basic
    with pytest.raises(agricolmap.UsageError, match="did you mean 'grid.cell'"):
        Options.describe("grid.cel")


def test_options_are_set_by_name_nested_or_not():
    options = Options(geometry_only=True, grid={"cell": 0.03})
    assert options["geometry_only"] is True and options["grid.cell"] == 0.03
    options["grid.cell"] = np.float32(0.5)
    options["seed"] = np.int64(7)
    options["dense.hops"] = 2.0
    options["refine"] = "cpd"
    assert options["grid.cell"] == 0.5 and options["seed"] == 7 and options["dense.hops"] == 2
    assert options.changed() == {
        "geometry_only": True, "refine": "cpd", "seed": 7, "grid.cell": 0.5, "dense.hops": 2,
    }  # fmt: skip
    assert "grid.cell" in options and "grid" not in options
    assert repr(Options(seed=3)) == "<agricolmap.Options 'default', seed=3>"


def test_what_makes_no_sense_changes_nothing():
    options = Options()
    for values, said in [
        ({"grid.cel": 1}, "did you mean 'grid.cell'"),
        ({"grid": {"cell": -1}}, "grid.cell cannot be '-1'; it must be a number, 0.005 to 1"),
        ({"grid.cell": "wide"}, "grid.cell cannot be 'wide'"),
        ({"grid.cell": [0.1]}, "grid.cell cannot be a list"),
        ({"grid.cell": float("nan")}, "nan"),
        ({"dense.hops": 1.5}, "a whole number"),
        ({"geometry_only": 1}, "geometry_only"),
        ({1: 2}, "names are str"),
    ]:
        with pytest.raises(agricolmap.UsageError, match=said):
            options.update({"seed": 5, **values})
        assert options == Options()
    with pytest.raises(agricolmap.UsageError, match="no-such-preset"):
        Options("no-such-preset")
    with pytest.raises(TypeError):
        hash(options)


def test_presets_differ():
    assert set(Options.presets()) == {"default", "paper", "paper-literal"}
    assert Options("paper").preset == "paper" and not Options("paper").changed()
    assert Options("paper") != Options()


def test_the_prior_is_one_value():
    options = Options()
    assert options.prior == Prior()
    options.prior = Prior(translation_m=2.0, heading_deg=4.0, scale=0.1, scale_unknown=True)
    assert options["prior.translation"] == 2.0 and options["prior.scale_unknown"] is True
    options["prior.scale"] = 0.2
    assert options.prior.scale == 0.2
    with pytest.raises(agricolmap.UsageError):
        options.prior = Prior(scale=0.9)
    assert options.prior.scale == 0.2
    options.prior = Prior(anywhere=True)
    assert options.prior.anywhere


def test_files_are_read_as_the_command_line_does(tmp_path):
    file = tmp_path / "options.yaml"
    file.write_text("grid:\n  cell: 0.031\n")
    options = Options.load(file, preset="paper")
    assert options["grid.cell"] == 0.031 and options.preset == "paper"
    with pytest.raises(agricolmap.InputError, match="none.yaml"):
        Options.load(tmp_path / "none.yaml")
    file.write_text("grid:\n  cel: 0.031\n")
    with pytest.raises(agricolmap.UsageError, match=r"options.yaml.*2"):
        Options.load(file)
    with pytest.raises(agricolmap.OutputError, match="none"):
        options.save(tmp_path / "none/options.yaml")
