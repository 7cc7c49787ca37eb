"""Arrays of other libraries, in and out; each test is for where the library is installed."""

import agricolmap
import numpy as np
import pytest


def test_open3d_gives_and_takes_clouds(flat):
    open3d = pytest.importorskip("open3d")
    xyz, colours = flat
    theirs = open3d.geometry.PointCloud()
    theirs.points = open3d.utility.Vector3dVector(xyz)
    theirs.colors = open3d.utility.Vector3dVector(colours / 255.0)
    cloud = agricolmap.Cloud(
        np.asarray(theirs.points),
        (255 * np.asarray(theirs.colors)).round().astype(np.uint8),
    )
    assert np.abs(cloud.xyz - xyz).max() < 1e-6 and np.array_equal(cloud.colours, colours)
    theirs.points = open3d.utility.Vector3dVector(cloud.xyz)
    assert np.array_equal(np.asarray(theirs.points), cloud.xyz)


def test_rasterio_writes_maps_where_they_lie(flat, tmp_path):
    rasterio = pytest.importorskip("rasterio")
    pytest.importorskip("agricolmap._gdal", reason="a build without GDAL")
    agricolmap.Cloud(*flat).write(tmp_path / "flat.ply")
    cloud = agricolmap.read(tmp_path / "flat.ply", crs="EPSG:32632")
    up = agricolmap.map_cloud(cloud, {"grid.cell": 0.05}).north_up()
    with rasterio.open(
        tmp_path / "green.tif",
        "w",
        driver="GTiff",
        width=up.shape[1],
        height=up.shape[0],
        count=1,
        dtype="float32",
        crs=up.crs.wkt,
        nodata=float("nan"),
        transform=rasterio.Affine(*up.affine),
    ) as file:
        file.write(up.excess_green, 1)
    with rasterio.open(tmp_path / "green.tif") as file:
        assert file.crs.to_epsg() == 32632
        (green,), (soil,) = file.sample([(500000.2, 5000000.5), (500000.8, 5000000.5)])
        assert green > 0.5 > 0.2 > soil
        assert file.bounds.top > file.bounds.bottom


def test_xarray_has_maps_with_their_coordinates(flat):
    xarray = pytest.importorskip("xarray")
    map_ = agricolmap.map_cloud(flat, {"grid.cell": 0.05})
    x, y = map_.centres()
    data = xarray.DataArray(
        map_.excess_green,
        dims=("row", "column"),
        coords={"x": (("row", "column"), x), "y": (("row", "column"), y)},
    )
    greenest = data.isel(data.argmax(...))
    assert 500000 < float(greenest.x) < 500000.5
