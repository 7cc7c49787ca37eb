"""Maps of a field, and what stands on it."""

import dataclasses
import datetime
import json
import threading

import agricolmap
import numpy as np
import pytest
from agricolmap import Strip


@pytest.fixture(scope="module")
def field(pairs):
    """A drone's cloud and two strips that were laid into it."""
    folder = pairs / "strips"
    drone = agricolmap.read(folder / "uav/point_cloud.ply")
    strips = []
    for name in ("ugv", "ugv_2"):
        robot = folder / name / "point_cloud.ply"
        result = agricolmap.register(folder / "uav/point_cloud.ply", robot)
        strips.append(Strip.of(name, robot, result, date=datetime.date(2026, 5, 31)))
    return drone, strips


@pytest.fixture(scope="module")
def map_(field):
    drone, strips = field
    return agricolmap.fuse(drone, strips, date=20260530)


def test_strips_have_their_place_in_the_map(field, map_):
    drone, strips = field
    assert [strip.name for strip in map_.strips] == ["ugv", "ugv_2"] and map_.warnings == ()
    for strip, given in zip(map_.strips, strips):
        mine = map_.source == strip.source
        assert abs(mine.sum() * map_.cell_m**2 - strip.owned_m2) < 1e-6
        assert 5 < strip.owned_m2 <= strip.seen_m2
        x, y = map_.centres()
        laid = given.cloud.xyz
        assert laid[:, 0].min() - 0.1 < x[mine].min() and x[mine].max() < laid[:, 0].max() + 0.1
        assert set(map_.date[mine]) == {20260531}
    assert set(map_.date[map_.source == 1]) == {20260530}
    assert map_.has_heights and map_.colour.shape == (*map_.shape, 3)
    seen = map_.source > 0
    at = np.column_stack([*np.nonzero(seen)[::-1], map_.surface_m[seen], np.ones(seen.sum())])
    heights = (at @ map_.file_from_cell.T)[:, 2]
    assert abs(np.nanmedian(heights) - np.median(drone.xyz[:, 2])) < 0.1
    assert np.nanmin(map_.cover) >= 0 and np.nanmax(map_.cover) <= 1
    assert map_.north_up().shape == map_.shape
    assert np.array_equal(map_.north_up().source, map_.source[::-1])


def test_order_does_not_count(field, map_):
    drone, strips = field
    turned = agricolmap.fuse(drone, strips[::-1], date=20260530)
    assert np.array_equal(turned.surface_m, map_.surface_m, equal_nan=True)


def test_what_cannot_be_fused_is_named(field, result):
    drone, strips = field
    rejected = dataclasses.replace(result, status=agricolmap.Status.REJECTED)
    with pytest.raises(agricolmap.UsageError, match="mine: its registration is rejected.*force"):
        Strip.of("mine", drone, rejected)
    far = agricolmap.Cloud(strips[0].cloud.xyz + [1000, 0, 0], strips[0].cloud.colours)
    for given, kind, said in [
        ([], agricolmap.UsageError, "no strip"),
        ([strips[0], strips[0]], agricolmap.UsageError, "two strips called 'ugv'"),
        ([Strip("far", far)], agricolmap.InputError, "far: does not touch"),
        ([Strip("odd", far, plane_error_m=-1)], agricolmap.UsageError, "odd: an error"),
        ([Strip("day", far, date=20269999)], agricolmap.UsageError, "day: date: is 20269999"),
    ]:
        with pytest.raises(kind, match=said):
            agricolmap.fuse(drone, given)
    with pytest.raises(agricolmap.UsageError, match="did you mean 'seam'"):
        agricolmap.fuse(drone, strips, {"seem": 1})
    stop = threading.Event()
    stop.set()
    with pytest.raises(agricolmap.Interrupted):
        agricolmap.fuse(drone, strips, stop=stop)


def test_options_of_maps_and_facts_are_described():
    names = [info.name for info in agricolmap.fuse_options()]
    assert {"cell", "seam", "adjust"} <= set(names)
    assert any(info.name == "grid" and info.unit == "m" for info in agricolmap.facts_options())


@pytest.fixture(scope="module")
def drawn():
    """Plants 0.2 m apart in rows 0.5 m apart, 10 cm high, of which three are missing; UTM."""
    col, row = np.meshgrid(np.arange(600), np.arange(400))
    at = np.column_stack([0.01 * (col.ravel() + 0.5), 0.01 * (row.ravel() + 0.5)])
    along, across = at[:, 0] % 0.2 - 0.1, at[:, 1] % 0.5 - 0.25
    green = np.hypot(along, across) < 0.045
    green &= ~((at[:, 1] > 2) & (at[:, 1] < 2.5) & (at[:, 0] > 3) & (at[:, 0] < 3.6))
    xyz = np.column_stack([at + [500000, 5000000], np.where(green, 80.1, 80.0)])
    noise = np.random.default_rng(1).integers(0, 12, (len(at), 1))
    colours = np.where(green[:, None], [40, 160, 40], [110, 95, 80]) + noise
    return xyz, colours.astype(np.uint8)


def test_plants_are_counted_where_they_stand(drawn):
    corners = np.array([[0, 0], [3, 0], [3, 1], [0, 1]]) + [500000, 5000000]
    facts = agricolmap.facts(drawn, plots={"corner": corners})
    assert facts.countable and facts.row_spacing_m == pytest.approx(0.5, abs=0.01)
    assert facts.plant_spacing_m == pytest.approx(0.2, abs=0.01)
    assert len(facts.rows) == 8 and facts.total.counted == 8 * 30 - 3
    assert len(facts.plants.place_m) == facts.total.counted
    at = facts.plants.place_m - [500000, 5000000]
    assert np.abs(at % [0.2, 0.5] - [0.1, 0.25]).max() < 0.02
    assert np.abs(facts.plants.height_m - 0.1).max() < 0.01
    assert (np.abs(at[:, 1] - (0.25 + 0.5 * facts.plants.row)) < 0.02).all() or (
        np.abs(at[:, 1] - (3.75 - 0.5 * facts.plants.row)) < 0.02
    ).all()
    assert facts.total.plants_low <= facts.total.plants <= facts.total.plants_high
    assert facts.plots["corner"].counted == 2 * 15
    (gap,) = facts.gaps.place_m
    assert np.abs(gap - [500003.3, 5000002.25]).max() < 0.02
    assert facts.gaps.to_m[0] - facts.gaps.from_m[0] == pytest.approx(0.8, abs=0.03)
    assert facts.rows[0].line.shape[1] == 2 and facts.squares[0].side_m == 2.0
    assert facts.weeds.place_m.shape == (len(facts.weeds.area_m2), 2)


def test_strips_have_facts_where_they_were_laid(field):
    _, strips = field
    cloud = strips[0].cloud
    facts = agricolmap.facts(cloud)
    assert 0.4 < facts.row_spacing_m < 0.6 and 0.1 < facts.total.cover < 0.5
    low, high = cloud.xyz[:, :2].min(axis=0), cloud.xyz[:, :2].max(axis=0)
    for row in facts.rows:
        assert (row.line > low - 0.3).all() and (row.line < high + 0.3).all()


def test_maps_have_facts_too(map_):
    facts = agricolmap.facts(map_, {"grid": 5})
    assert 0.4 < facts.row_spacing_m < 0.6 and facts.squares[0].side_m == 5
    assert 100 < facts.total.area_m2 < 250


def counts(facts):
    total = facts.total
    return total.plants, total.counted, total.gaps, total.cover, len(facts.plants.row)


def test_maps_have_the_facts_of_the_program(program, tmp_path):
    """Where strips are, in their finer cells."""
    pytest.importorskip("agricolmap._gdal", reason="a build without GDAL")
    program(
        *("simulate", "--crop", "sugar_beet_10m", "--field.plant-size", 0.6, "--field.width", 9),
        *("--field.height", 9, "--ugv.length", 3, "--seed", 104, "--no-pictures"),
        *("-o", tmp_path / "beets"),
    )
    drone, robot = (tmp_path / "beets" / name / "point_cloud.ply" for name in ("uav", "ugv"))
    program("register", drone, robot, "-o", tmp_path / "strip", "--no-pictures")
    program("fuse", drone, tmp_path / "strip", "-o", tmp_path / "map", "--no-pictures")
    program("facts", tmp_path / "map", "-o", tmp_path / "facts", "--no-pictures")
    said = json.loads((tmp_path / "facts/facts.json").read_text())["total"]
    read = agricolmap.FieldMap.read(tmp_path / "map")
    assert [strip.name for strip in read.strips] == ["strip"]
    fine = read.strips[0].fine
    assert fine.cell_m < read.cell_m and fine.plant_height_m.shape == fine.shape
    shown = np.isfinite(fine.excess_green).sum() * fine.cell_m**2
    assert 0.5 * read.strips[0].owned_m2 < shown <= 1.01 * read.strips[0].owned_m2
    facts = agricolmap.facts(read)
    assert facts.total.counted == said["plants"]["counted"] > 100
    assert facts.total.plants == said["plants"]["estimate"]
    assert facts.total.gaps == said["gaps"]["count"]
    assert facts.total.cover == said["cover"]
    assert counts(agricolmap.facts(tmp_path / "map")) == counts(facts)
    # The same clouds, fused here: the program's went through a file of whole millimetres.
    strip = Strip.of("strip", robot, agricolmap.register(drone, robot))
    fused = agricolmap.facts(agricolmap.fuse(drone, [strip]))
    assert fused.total.counted == pytest.approx(facts.total.counted, rel=0.02)


def test_facts_say_why_there_are_none(flat, map_):
    xyz, _ = flat
    with pytest.raises(agricolmap.InputError, match="source: no crop facts"):
        agricolmap.facts((xyz, np.full(xyz.shape, 100, np.uint8)))
    with pytest.raises(agricolmap.UsageError, match=r"plots\['a'\]: has shape \(2, 2\)"):
        agricolmap.facts(map_, plots={"a": [[0, 0], [1, 1]]})
    with pytest.raises(agricolmap.InputError, match="nothing of the 1 plots"):
        agricolmap.facts(map_, plots={"a": [[0, 0], [1, 1], [1, 0]]})
