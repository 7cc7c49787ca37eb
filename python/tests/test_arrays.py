"""Clouds from arrays and files, and what is said of arrays that are none."""

import agricolmap
import numpy as np
import pytest


def test_points_keep_millimetres_far_from_zero(flat):
    xyz, colours = flat
    cloud = agricolmap.Cloud(xyz, colours, name="mine")
    assert len(cloud) == len(xyz) and cloud.name == "mine"
    assert np.abs(cloud.xyz - xyz).max() < 1e-6
    assert np.array_equal(cloud.colours, colours)
    assert cloud.local_xyz.dtype == np.float32 and cloud.colours.dtype == np.uint8
    assert np.abs(cloud.local_xyz + cloud.origin - xyz).max() < 1e-6
    assert repr(cloud) == "<agricolmap.Cloud 'mine': 10000 coloured points>"
    assert not cloud.crs and cloud.dropped_points == 0


def test_points_may_be_of_any_real_dtype_and_layout(flat):
    xyz, colours = flat
    local = xyz - xyz[0]
    for given in (
        local,
        local.astype(np.float32),
        np.asfortranarray(local),
        local[::2],
        local.astype(int),
        local.tolist(),
    ):
        assert np.abs(agricolmap.Cloud(given).xyz - np.asarray(given)).max() < 1e-6
    assert agricolmap.Cloud(xyz).colours is None
    assert np.array_equal(agricolmap.Cloud(xyz[::2], colours[::2]).colours, colours[::2])


def test_views_outlive_the_cloud_and_cannot_be_written_to(flat):
    view = agricolmap.Cloud(*flat).colours
    assert np.array_equal(view, flat[1])
    with pytest.raises(ValueError):
        view[0] = 0
    with pytest.raises(AttributeError):
        agricolmap.Cloud(*flat).xyz = flat[0]


def test_what_is_not_finite_is_left_out(flat):
    xyz, colours = flat
    xyz[3] = np.nan
    cloud = agricolmap.Cloud(xyz, colours)
    assert len(cloud) == len(xyz) - 1 and cloud.dropped_points == 1
    with pytest.raises(agricolmap.InputError, match="mine"):
        agricolmap.Cloud(np.full((5, 3), np.nan), name="mine")
    with pytest.raises(agricolmap.InputError, match="points"):
        agricolmap.Cloud(np.empty((0, 3)))


def test_single_precision_that_has_cost_millimetres_is_said(flat):
    xyz, _ = flat
    cloud = agricolmap.Cloud(xyz.astype(np.float32), name="mine")
    assert "mine" in cloud.warnings[0] and "float64" in cloud.warnings[0]
    assert not agricolmap.Cloud(xyz).warnings
    assert not agricolmap.Cloud((xyz - xyz[0]).astype(np.float32)).warnings


@pytest.mark.parametrize(
    ("xyz", "said"),
    [
        (np.zeros((3, 100)), r"xyz: has shape \(3, 100\) \(transposed\?\); give coordinates"),
        (np.zeros(3), r"xyz: has shape \(3,\)"),
        (np.zeros((4, 4)), r"xyz: has shape \(4, 4\)"),
        (np.zeros((4, 3), complex), "xyz: has dtype complex128"),
        (np.zeros((4, 3), bool), "xyz: has dtype bool"),
        ([["1", "2", "3"]], "xyz: has dtype <U1"),
        ([[1, 2, 3], [4, 5]], "xyz: "),
        (None, "xyz: has dtype object"),
    ],
)
def test_wrong_points_are_named(xyz, said):
    with pytest.raises(agricolmap.UsageError, match=said):
        agricolmap.Cloud(xyz)


@pytest.mark.parametrize(
    ("colours", "said"),
    [
        (np.zeros((4, 3)), r"colours: has dtype float64.*of colours from 0 to 1"),
        (np.zeros((4, 3), np.uint16), r"colours: has dtype uint16.*of 16 bits"),
        (np.zeros((4, 3), int), "colours: has dtype int64"),
        (np.zeros((5, 3), np.uint8), r"colours: has shape \(5, 3\).*shape \(4, 3\)"),
        (np.zeros((4, 4), np.uint8), r"colours: has shape \(4, 4\)"),
    ],
)
def test_wrong_colours_are_named(colours, said):
    with pytest.raises(agricolmap.UsageError, match=said):
        agricolmap.Cloud(np.zeros((4, 3)), colours)


@pytest.mark.parametrize("name", ["cloud.ply", "cloud.pcd", "cloud.las"])
def test_clouds_go_out_and_come_back(tmp_path, flat, name):
    cloud = agricolmap.Cloud(*flat)
    shift = np.eye(4)
    shift[:3, 3] = [1, 2, 3]
    cloud.write(tmp_path / name, shift)
    read = agricolmap.read(tmp_path / name)
    assert np.abs(read.xyz - (flat[0] + [1, 2, 3])).max() < 1e-3
    assert np.array_equal(read.colours, flat[1])
    assert read.name == str(tmp_path / name)
    assert read.fields.startswith("x, y, z")


def test_files_that_cannot_be_used_are_named(tmp_path, flat):
    cloud = agricolmap.Cloud(*flat)
    with pytest.raises(agricolmap.InputError, match="none.ply"):
        agricolmap.read(tmp_path / "none.ply")
    (tmp_path / "cut.ply").write_text("ply\nformat ascii 1.0\n")
    with pytest.raises(agricolmap.InputError, match="cut.ply"):
        agricolmap.read(str(tmp_path / "cut.ply"))
    with pytest.raises(agricolmap.OutputError, match="none"):
        cloud.write(tmp_path / "none" / "cloud.ply")
    with pytest.raises(agricolmap.UsageError, match="cloud.stl"):
        cloud.write(tmp_path / "cloud.stl")
    with pytest.raises(agricolmap.UsageError, match="path: is a int"):
        agricolmap.read(3)


def test_coordinate_systems_are_kept_and_changed(tmp_path, flat):
    pytest.importorskip("agricolmap._gdal", reason="a build without GDAL")
    agricolmap.Cloud(*flat).write(tmp_path / "plain.ply")
    zone_32 = agricolmap.read(tmp_path / "plain.ply", crs="EPSG:32632")
    assert zone_32.crs.name == "WGS 84 / UTM zone 32N" and zone_32.crs
    zone_32.write(tmp_path / "zone.las")
    assert agricolmap.read(tmp_path / "zone.las").crs.name == zone_32.crs.name
    zone_33 = agricolmap.read(tmp_path / "zone.las", target_crs="EPSG:32633")
    assert zone_33.crs.name == "WGS 84 / UTM zone 33N"
    assert abs(zone_33.xyz[0, 0] - zone_32.xyz[0, 0]) > 1e5
    with pytest.raises(agricolmap.UsageError, match="EPSG:nothing"):
        agricolmap.read(tmp_path / "plain.ply", crs="EPSG:nothing")
    with pytest.raises(agricolmap.InputError, match="does not say"):
        agricolmap.read(tmp_path / "plain.ply", target_crs="EPSG:32633")
    own = agricolmap.Cloud(flat[0], crs=zone_32.crs)
    assert own.crs == zone_32.crs


def test_a_pair_is_brought_into_the_frame_of_the_fixed_one(tmp_path, pairs):
    pytest.importorskip("agricolmap._gdal", reason="a build without GDAL")
    folder = pairs / "georeferenced"
    drone = agricolmap.read(folder / "uav/point_cloud.ply", crs="EPSG:32632")
    drone.write(tmp_path / "drone.las")
    result = agricolmap.register(tmp_path / "drone.las", folder / "ugv/point_cloud.ply")
    assert result.accepted and result.crs.name == "WGS 84 / UTM zone 32N"
    assert any("coordinate system" in warning for warning in result.warnings)
    agricolmap.read(folder / "ugv/point_cloud.ply", crs="EPSG:32632").write(tmp_path / "robot.las")
    other = agricolmap.read(tmp_path / "robot.las", target_crs="EPSG:32633")
    other.write(tmp_path / "other.las")
    again = agricolmap.register(drone, tmp_path / "other.las")
    assert again.accepted
    laid = again.aligned(tmp_path / "other.las")
    there = result.aligned(folder / "ugv/point_cloud.ply")
    assert laid.crs == result.crs and np.abs(laid.xyz - there.xyz).max() < 0.05
    assert np.abs(other.xyz - there.xyz).max() > 1e5
    with pytest.raises(agricolmap.UsageError, match="moving: is in WGS 84 / UTM zone 33N"):
        agricolmap.register(drone, other)


def test_matrices_and_paths_go_out_and_come_back(tmp_path):
    moved = np.eye(4)
    moved[:3] = np.random.default_rng(1).normal(size=(3, 4))
    agricolmap.write_matrix(tmp_path / "moved.txt", moved)
    assert np.array_equal(agricolmap.read_matrix(tmp_path / "moved.txt"), moved)
    (tmp_path / "path.txt").write_text("1 2\n3 4\n")
    assert agricolmap.read_path(tmp_path / "path.txt").tolist() == [[1, 2, 0], [3, 4, 0]]
    with pytest.raises(agricolmap.InputError, match="none.txt"):
        agricolmap.read_matrix(tmp_path / "none.txt")
    with pytest.raises(agricolmap.OutputError, match="none"):
        agricolmap.write_matrix(tmp_path / "none/moved.txt", moved)


def test_errors_are_of_one_family():
    for kind in ("UsageError", "InputError", "OutputError", "Interrupted"):
        assert issubclass(getattr(agricolmap, kind), agricolmap.Error)
    assert issubclass(agricolmap.UsageError, ValueError)
    assert not issubclass(agricolmap.InputError, agricolmap.UsageError)
