"""What changed between two maps of a field."""

import csv
import json
import threading

import agricolmap
import numpy as np
import pytest
from agricolmap import Cloud, Strip

CORNER = np.array([500000.0, 5000000.0])
WEST = CORNER + np.array([[0.5, 0.5], [2.5, 0.5], [2.5, 3.5], [0.5, 3.5]])
EAST = WEST + [3, 0]


def clouds(growth, places):
    """A drone's cloud and a strip's of plants in rows, of which the eastern ones have grown."""
    random = np.random.default_rng(places)

    def cloud(x, y, step):
        col, row = np.meshgrid(np.arange(x[0], x[1], step), np.arange(y[0], y[1], step))
        at = np.column_stack([col.ravel(), row.ravel()]) + random.uniform(0, step / 2, (col.size, 2))
        plant = np.hypot(at[:, 0] % 0.4 - 0.2, at[:, 1] % 0.5 - 0.25) < 0.12
        height = np.where(plant, 0.15 + growth * (at[:, 0] > 3), 0) + random.normal(0, 0.003, len(at))
        colours = np.where(plant[:, None], [40, 160, 40], [110, 95, 80]).astype(np.uint8)
        colours[:, 1] += random.integers(0, 12, len(at)).astype(np.uint8)
        return Cloud(np.column_stack([at + CORNER, 80 + height]), colours, crs=UTM)

    return cloud((0, 6), (0, 4), 0.02), cloud((1, 5), (1, 3), 0.01)


UTM = agricolmap.Crs("WGS 84 / UTM zone 32N", "")


def fused(growth, places=1, shift=0.0):
    drone, strip = clouds(growth, places)
    laid = Strip("monday", strip, 0.005 + shift, 0.005)
    return agricolmap.fuse(drone, [laid], {"cell": 0.04})


@pytest.fixture(scope="module")
def maps():
    return fused(0.0), fused(0.1)


def test_growth_is_found_where_it_is(maps):
    change = agricolmap.diff(*maps, plots={"west": WEST, "east": EAST}, grid=1.0)
    assert change.shape == change.significant.shape == change.detection_m.shape
    assert change.has_heights and change.frame_error_m == (0, 0) and change.warnings == ()
    x, _ = change.centres()
    seen = np.isfinite(change.height_change_m)
    assert change.significant.dtype == bool and not change.significant[~seen].any()
    assert (np.abs(change.height_change_m[seen]) > change.detection_m[seen]).sum() == (
        change.significant.sum()
    )
    assert change.significant[x > CORNER[0] + 3.1].mean() > 0.05
    assert change.significant[x < CORNER[0] + 2.9].mean() < 0.02
    west, east = change.plots["west"], change.plots["east"]
    assert east.more_than_errors and not west.more_than_errors
    assert east.compared_m2 == pytest.approx(6, abs=0.2)
    assert east.compared.mean_m > east.level_m > abs(west.compared.mean_m)
    grown = change.plant_height_change_m[change.significant & (x > CORNER[0] + 3.1)]
    assert np.nanmedian(grown) == pytest.approx(0.1, abs=0.02)
    assert change.plant_height.cells > 0 and np.isfinite(east.plant_height.after)
    assert east.cover.after == pytest.approx(east.cover.before, abs=0.05)
    assert east.compared.volume_low_m3 < east.compared.volume_m3 < east.compared.volume_high_m3
    assert change.rise.area_m2 > 10 * change.fall.area_m2
    assert change.bare_ground.cells > 0 and abs(change.bare_ground.mean_m) < 0.01
    assert np.nansum(change.height_change_m) * change.cell_m**2 == pytest.approx(
        change.compared.volume_m3, rel=1e-3
    )
    squares = {square.corner_m: square for square in change.squares}
    assert squares[tuple(CORNER + [4, 1])].change.more_than_errors
    assert all(square.side_m == 1 for square in change.squares)
    up = change.north_up()
    assert np.array_equal(up.height_change_m, change.height_change_m[::-1], equal_nan=True)


def test_errors_that_are_given_count(maps):
    own = agricolmap.diff(*maps)
    given = agricolmap.diff(*maps, error_a=(0.2, 0), error_b=[0.2, 0], frame_error=(0.1, 0.01))
    assert given.median_detection_m > 1.96 * np.hypot(0.2, 0.2) > own.median_detection_m
    assert given.frame_error_m == (0.1, 0.01) and given.rise.cells == 0


def test_maps_of_two_flights_are_warned_of(maps):
    drone, strip = clouds(0.1, 3)
    fewer = Cloud(drone.xyz[:-1], drone.colours[:-1], crs=UTM)
    other = agricolmap.fuse(fewer, [Strip("monday", strip, 0.005, 0.005)], {"cell": 0.04})
    assert any("frame_error" in line for line in agricolmap.diff(maps[0], other).warnings)
    told = agricolmap.diff(maps[0], other, frame_error=(0.01, 0.01)).warnings
    assert not any("frame_error" in line for line in told)


def test_what_cannot_be_compared_is_named(maps):
    before, after = maps
    for words, kind, said in [
        ({"error_a": 0.1}, agricolmap.UsageError, r"error_a: has shape \(\)"),
        ({"frame_error": (1, -1)}, agricolmap.UsageError, "frame_error: is 1, -1"),
        ({"error_b": (101, 0)}, agricolmap.UsageError, "from 0 to 100 m"),
        ({"grid": 0.01}, agricolmap.UsageError, "grid: is 0.01 m; must be from 0.1 to 1000 m"),
        ({"grid": [1, 2]}, agricolmap.UsageError, r"grid: is \[1, 2\]"),
        ({"plots": {"a": [[0, 0], [1, 0], [1, np.nan]]}}, agricolmap.UsageError, "not finite"),
        ({"plots": {"a": [[0, 0]]}}, agricolmap.UsageError, r"plots\['a'\]: has shape"),
        ({"plots": {"a": [[0, 0], [1, 0], [1, 1]]}}, agricolmap.InputError, "any of the 1 plots"),
    ]:
        with pytest.raises(kind, match=said):
            agricolmap.diff(before, after, **words)
    with pytest.raises(agricolmap.UsageError, match="map_b: is no map"):
        agricolmap.diff(before, np.zeros((3, 3)))
    stop = threading.Event()
    stop.set()
    with pytest.raises(agricolmap.Interrupted):
        agricolmap.diff(before, after, stop=stop)


def test_coordinate_systems_are_compared_and_not_their_names(folders, tmp_path):
    """As the program does; one name may stand for two systems, and two texts for one."""
    gdal = pytest.importorskip("osgeo.gdal")
    osr = pytest.importorskip("osgeo.osr")
    errors = {"error_a": (0.01, 0.0), "error_b": (0.01, 0.0)}

    def surface(name, system):
        path = str(tmp_path / f"{name}.tif")
        reference = osr.SpatialReference()
        reference.SetFromUserInput(system)
        copy = gdal.Translate(path, str(folders[0] / "layers/surface.tif"))
        copy.SetProjection(reference.ExportToWkt())
        return path

    grid = "+proj=tmerc +lat_0=0 +lon_0={} +k=0.9996 +x_0=500000 +y_0=0 +ellps=WGS84 +units=m"
    west, east = surface("west", grid.format(9.2)), surface("east", grid.format(15.7))
    with pytest.raises(agricolmap.InputError, match="different coordinate systems"):
        agricolmap.diff(west, east, **errors)
    plain, tall = surface("plain", "EPSG:32632"), surface("tall", "EPSG:32632+5773")
    change = agricolmap.diff(plain, tall, **errors)
    assert change.compared.mean_m == 0 and change.warnings == ()


def test_folders_are_compared_as_the_program_does(folders, program, tmp_path):
    before, after = folders
    low = agricolmap.FieldMap.read(before).centres()[0].min(), 0
    y = agricolmap.FieldMap.read(before).centres()[1].min()
    corners = [[low[0] + 2, y + 2], [low[0] + 8, y + 2], [low[0] + 8, y + 9], [low[0] + 2, y + 9]]
    plots = {
        "type": "FeatureCollection",
        "features": [
            {
                "type": "Feature",
                "properties": {"plot": "one"},
                "geometry": {"type": "Polygon", "coordinates": [[*corners, corners[0]]]},
            }
        ],
    }
    (tmp_path / "plots.geojson").write_text(json.dumps(plots))
    program(
        *("diff", before, after, "-o", tmp_path / "change", "--frame-error", 0.01, 0.02),
        *("--grid", 2, "--plots", tmp_path / "plots.geojson", "--no-pictures"),
    )
    said = json.loads((tmp_path / "change/change.json").read_text())
    change = agricolmap.diff(
        before, after, frame_error=(0.01, 0.02), plots={"one": corners}, grid=2
    )
    assert change.shape == (said["grid"]["rows"], said["grid"]["cols"])
    surface = said["surface"]
    for name in ("compared", "rise", "fall", "bare_ground"):
        share, words = getattr(change, name), surface[name]
        assert share.cells == words["cells"] and share.cells > 0
        assert share.volume_m3 == pytest.approx(words["volume_m3"], abs=1e-9)
        interval = [share.volume_low_m3, share.volume_high_m3]
        assert interval == pytest.approx(words["volume_interval_m3"], abs=1e-9)
        assert share.median_m == pytest.approx(words["median_m"], abs=1e-9)
    assert change.median_detection_m == surface["median_detection_m"]
    assert change.cover.after == said["cover"]["mean_after"]
    assert change.plant_height.before == said["plant_height"]["median_before_m"]

    def table(name):
        with open(tmp_path / "change" / name, newline="") as file:
            return list(csv.DictReader(file))

    (row,) = table("plots.csv")
    parts = [(change.plots["one"], row)]
    rows = table("grid.csv")
    assert len(rows) == len(change.squares)
    parts += [(square.change, row) for square, row in zip(change.squares, rows)]
    for part, row in parts:
        assert part.compared_m2 == pytest.approx(float(row["compared_m2"]), abs=0.006)
        if not row["height_change_m"]:
            assert part.compared.cells == 0
            continue
        assert part.compared.mean_m == pytest.approx(float(row["height_change_m"]), abs=6e-5)
        assert part.level_m == pytest.approx(float(row["height_change_level_m"]), abs=6e-5)
        assert part.more_than_errors == (row["more_than_errors"] == "1")


def test_what_is_no_map_is_refused(tmp_path, folders):
    with pytest.raises(agricolmap.InputError, match="none.tif: there is no such file or folder"):
        agricolmap.FieldMap.read(tmp_path / "none.tif")
    with pytest.raises(agricolmap.InputError, match="map.json"):
        agricolmap.FieldMap.read(tmp_path)
    with pytest.raises(agricolmap.InputError, match="map.json"):
        agricolmap.diff(folders[0], tmp_path)


def test_surface_models_of_others(tmp_path, folders, program):
    """Two bare GeoTIFFs, and one beside a map, as from the command line."""
    before, after = (folder / "layers/surface.tif" for folder in folders)
    with pytest.raises(agricolmap.UsageError, match="map_a: nothing is known of its errors.*error_a"):
        agricolmap.diff(before, after)
    with pytest.raises(agricolmap.UsageError, match="error_b"):
        agricolmap.diff(folders[0], after)
    for maps, flags, errors in (
        ((before, after), ("--error-a", 0.01, 0.02, "--error-b", 0.02, 0.0), (0.01, 0.02)),
        ((folders[0], after), ("--error-b", 0.02, 0.0), None),
    ):
        out = tmp_path / f"change_{errors is None}"
        program("diff", *maps, "-o", out, "--no-pictures", *flags)
        surface = json.loads((out / "change.json").read_text())["surface"]
        change = agricolmap.diff(*maps, error_a=errors, error_b=(0.02, 0.0))
        for name in ("compared", "rise", "fall"):
            share = getattr(change, name)
            assert share.cells == surface[name]["cells"] and share.cells > 0
            assert share.volume_m3 == pytest.approx(surface[name]["volume_m3"], abs=1e-9)
        assert change.median_detection_m == surface["median_detection_m"]
        assert change.cover is None and change.warnings == ()
    model = agricolmap.FieldMap.read(before)
    assert np.isnan(model.cover).all() and np.isfinite(model.surface_m).any()
    with pytest.raises(agricolmap.Error):
        agricolmap.facts(model)


def test_surfaces_far_above_zero_lose_nothing(maps):
    """Floats have 0.5 mm at 8 km: heights are compared above the maps' own zeros."""
    raised = []
    for growth in (0.0, 0.1):
        drone, strip = (
            Cloud(cloud.xyz + [0, 0, 8000], cloud.colours, crs=UTM) for cloud in clouds(growth, 1)
        )
        raised.append(agricolmap.fuse(drone, [Strip("monday", strip, 0.005, 0.005)], {"cell": 0.04}))
    low, high = agricolmap.diff(*maps), agricolmap.diff(*raised)
    assert high.compared.mean_m == pytest.approx(low.compared.mean_m, abs=1e-4)
