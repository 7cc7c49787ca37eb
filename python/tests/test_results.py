"""The registration: what comes out."""

import json
import os
import pickle
import re
import shutil
import subprocess

import agricolmap
import numpy as np
import pytest


def test_all_parts_are_there(result):
    assert result.plane_probability > 0.8 and 0 < result.place_probability <= 1
    assert result.transform.shape == (4, 4) and result.transform.dtype == np.float64
    assert 0 < result.uncertainty.expected_rms_m < 0.05
    covariance = result.covariance
    assert covariance.shape == (6, 6) and np.allclose(covariance, covariance.T)
    assert np.linalg.eigvalsh(covariance).min() > 0
    assert result.heights.measured and result.heights.deviation_m < 0.045
    assert result.heights.words and not result.heights.limit
    scale = result.heights.vertical_scale  # the ground of the pair is flat
    assert scale is None or abs(scale - 1.0) < 3.0 * result.heights.vertical_scale_deviation
    assert 0 < result.evidence.agreeing_blocks <= result.evidence.blocks
    assert np.linalg.norm(result.parts.shift_m) > 0.5
    assert list(result.times)[0] == "level" and min(result.times.values()) >= 0
    assert result.warnings == () and result.alternatives == () and not result.crs
    assert "accepted" in repr(result)


def test_clouds_are_laid(robot, result):
    laid = result.aligned(robot)
    assert np.abs(laid.xyz - result.place(robot.xyz)).max() < 1e-4
    assert np.array_equal(laid.colours, robot.colours)
    assert np.array_equal(agricolmap.aligned(robot, result).xyz, laid.xyz)
    with pytest.raises(agricolmap.UsageError, match="points: has shape"):
        result.place(np.zeros(3))


def test_bends_are_followed_point_by_point(pairs, drone, robot, guess):
    """A strip whose second half slipped by 0.3 m, laid where it was before."""
    truth = agricolmap.read_matrix(pairs / "same_field/truth.txt")
    at = robot.xyz
    belongs = at @ truth[:3, :3].T + truth[:3, 3]
    at[at[:, 1] > np.median(at[:, 1]), 0] += 0.3
    slipped = agricolmap.Cloud(at, robot.colours)
    result = agricolmap.register(drone, slipped, guess)
    assert result.accepted, str(result)
    bend = result.deformation
    assert len(bend.slips) == 1 and 0.25 < np.linalg.norm(bend.slips[0].offset_m) < 0.35
    assert bend.nodes and bend.rms_m > 0.05 and bend.gain > 0
    assert bend.nodes[0].place_m.shape == bend.nodes[0].deviation_m.shape == (3,)

    def rms(laid):
        return np.sqrt(((laid - belongs)[:, :2] ** 2).sum(axis=1).mean())

    assert rms(result.place(at)) < 0.05
    assert rms(result.place(at) - bend.displacement(at)) > 0.07
    assert np.abs(result.aligned(slipped).xyz - result.place(at)).max() < 1e-4


def test_maps_lie_on_each_other(result):
    fixed, moving = result.maps()
    assert fixed.colour.shape == (*fixed.shape, 3) and fixed.height_m.shape == fixed.shape
    x, y = moving.centres()
    seen = ~np.isnan(moving.excess_green)
    cells = np.floor(fixed.cells_of(np.column_stack([x[seen], y[seen]]))).astype(int)
    inside = ((cells >= 0) & (cells < fixed.shape[::-1])).all(axis=1)
    there = fixed.excess_green[cells[inside, 1], cells[inside, 0]]
    here = moving.excess_green[seen][inside]
    both = ~np.isnan(there)
    assert both.sum() > 1000
    assert np.corrcoef(here[both], there[both])[0, 1] > 0.5


def test_a_map_of_one_cloud_lies_where_the_cloud_does(flat):
    xyz, colours = flat
    map_ = agricolmap.map_cloud(agricolmap.Cloud(xyz, colours), {"grid.cell": 0.05})
    assert map_.cell_m == 0.05 and repr(map_).endswith("of 0.05 m>")
    x, y = map_.centres()
    green = map_.excess_green > 0.5
    assert abs(x[green].mean() - 500000.25) < 0.03 and abs(y[green].mean() - 5000000.5) < 0.03
    assert np.nanmax(np.abs(map_.height_m)) < 1e-3
    up = map_.north_up()
    assert up.affine[4] == pytest.approx(-0.05) and map_.affine[4] == pytest.approx(0.05)
    up_x, up_y = up.centres()
    assert np.allclose(up_x, x[::-1]) and np.allclose(up_y, y[::-1])
    assert np.array_equal(up.colour, map_.colour[::-1])
    assert np.allclose(map_.cells_of([[x[2, 3], y[2, 3]]]), [[3.5, 2.5]])
    with pytest.raises(agricolmap.UsageError, match=r"xy: has shape \(2,\)"):
        map_.cells_of([1, 2])
    four = np.linspace(0, 1.99, 200)
    four = np.column_stack([np.repeat(four, 200), np.tile(four, 200), np.zeros(40000)])
    small = agricolmap.map_cloud(four, {"grid": {"cell": 0.5, "sigma": 1}})
    assert small.shape == (4, 4) and small.north_up().affine[4] == pytest.approx(-0.5)
    assert np.isnan(agricolmap.map_cloud(xyz).excess_green).all()


def test_reports_and_pictures_are_written(result, tmp_path):
    pytest.importorskip("agricolmap._pictures", reason="a build without pictures")
    names = result.write_report(tmp_path / "new")
    assert (names[0], names[-1]) == ("registration.json", "report.html")
    assert "overlay_after.png" in names
    assert all((tmp_path / "new" / name).stat().st_size > 500 for name in names)
    report = json.loads((tmp_path / "new/registration.json").read_text())
    assert report["pictures"] == names[1:-1]
    assert report["transform"]["matrix"] == result.transform.tolist()
    assert {**report, "pictures": []} == result.report()
    with pytest.raises(agricolmap.OutputError, match="exists already.*overwrite=True"):
        result.write_report(tmp_path / "new")
    again = result.write_report(tmp_path / "new", pictures=False, overwrite=True)
    assert sorted(again) == sorted(path.name for path in (tmp_path / "new").iterdir())
    (tmp_path / "new/registration.json").unlink()
    with pytest.raises(agricolmap.OutputError, match="report.html: exists already"):
        result.write_report(tmp_path / "new")
    (tmp_path / "file").write_text("")
    with pytest.raises(agricolmap.OutputError, match="file"):
        result.write_report(tmp_path / "file" / "inside")


def page_data(page, name):
    """What a page carries of that name."""
    text = page.read_text()
    found = re.search(rf'<script type="application/json" id="data-{name}">(.*?)</script>', text, re.S)
    return json.loads(found[1])


def test_the_page_is_that_of_the_program(pairs, tmp_path):
    """Of the same files, and of the clouds in memory."""
    pytest.importorskip("agricolmap._pictures", reason="a build without pictures")
    fixed, moving = (pairs / "same_field" / name / "point_cloud.ply" for name in ("uav", "ugv"))
    prior = pairs / "same_field/prior.txt"
    subprocess.run(
        [
            os.environ["AGRICOLMAP_PROGRAM"],
            *("register", fixed, moving, "--prior", prior, "-o", tmp_path / "program"),
        ],
        check=True,
        capture_output=True,
    )
    agricolmap.register(fixed, moving, prior).write_report(tmp_path / "files")
    clouds = agricolmap.read(fixed), agricolmap.read(moving)
    agricolmap.register(*clouds, prior).write_report(tmp_path / "clouds")
    pages = [tmp_path / name / "report.html" for name in ("program", "files", "clouds")]
    scenes = [page_data(page, "scene") for page in pages]
    assert scenes[0]["maps"] and scenes[0] == scenes[1] == scenes[2]
    facts = [page_data(page, "facts") for page in pages]
    assert facts[0]["scene_missing"] == "" and facts[0] == facts[1] == facts[2]


def test_a_page_of_other_clouds_is_refused(result, robot, pairs, tmp_path):
    pytest.importorskip("agricolmap._pictures", reason="a build without pictures")
    fixed, moving = tmp_path / "fixed.ply", tmp_path / "moving.ply"
    for name, path in (("uav", fixed), ("ugv", moving)):
        shutil.copy(pairs / "same_field" / name / "point_cloud.ply", path)
    found = agricolmap.register(fixed, moving, pairs / "same_field/prior.txt")
    agricolmap.Cloud(robot.xyz[::2], robot.colours[::2]).write(moving)
    with pytest.raises(agricolmap.UsageError, match="moving.ply: is not the moving cloud"):
        found.write_report(tmp_path / "new")
    moving.unlink()
    with pytest.raises(agricolmap.InputError, match="moving.ply"):
        found.write_report(tmp_path / "new")
    found.write_report(tmp_path / "new", pictures=False)
    missing = page_data(tmp_path / "new/report.html", "facts")["scene_missing"]
    assert missing == "the report was written without pictures"


def test_reports_are_applied_by_the_program(result, pairs, robot, tmp_path):
    """The program lays whole files by what Python wrote."""
    result.write_report(tmp_path / "run", pictures=False)
    subprocess.run(
        [
            os.environ["AGRICOLMAP_PROGRAM"],
            *("apply", tmp_path / "run", pairs / "same_field/ugv/point_cloud.ply"),
            *("-o", tmp_path / "laid"),
        ],
        check=True,
        capture_output=True,
    )
    (laid,) = (tmp_path / "laid").glob("*.ply")
    assert np.abs(agricolmap.read(laid).xyz - result.place(robot.xyz)).max() < 1e-4


def test_what_has_no_place_lays_nothing(flat):
    """Bare ground has nothing to go by."""
    xyz, _ = flat
    col = (xyz[:, :2] - xyz[0, :2]) * 5
    wide = np.column_stack([xyz[:, :2] + col, xyz[:, 2]])
    grey = np.full(wide.shape, 100, np.uint8)
    result = agricolmap.register((wide, grey), (wide, grey))
    assert result.status is agricolmap.Status.REJECTED
    if result.transform is None:
        assert result.parts is None and result.covariance is None and result.heights is None
        with pytest.raises(agricolmap.UsageError, match="without a transformation"):
            result.place(wide)
        with pytest.raises(agricolmap.UsageError, match="without a transformation"):
            result.aligned(wide)
        fixed, moving = result.maps()
        assert np.allclose(fixed.file_from_cell, moving.file_from_cell)


def test_results_say_that_they_cannot_be_pickled(result):
    with pytest.raises(TypeError, match="report"):
        pickle.dumps(result)
