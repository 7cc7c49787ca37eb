"""What changed on a field between two maps of it, and what of that is more than their errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, PathLike
from ._cloud import Crs
from ._errors import InputError, UsageError
from ._field import FieldMap, corners, map_handle
from ._maps import Cells
from ._register import Stop

Singles = npt.NDArray[np.float32]
Error = Optional[Sequence[float]]


@dataclass(frozen=True)
class Share:
    """How much a set of cells changed.

    Deviations take what is expected of a cell to be one error of all cells of its source in its map:
    a larger field makes no volume surer.

    Attributes:
        cells: how many there are.
        area_m2: of them [m²].
        volume_m3: mean change times area [m³].
        volume_low_m3, volume_high_m3: hold it in 95 of 100 [m³].
        mean_m: mean change [m].
        mean_deviation_m: of it, standard deviation [m].
        median_m: of the changes [m]; 0 without cells.
    """

    cells: int
    area_m2: float
    volume_m3: float
    volume_low_m3: float
    volume_high_m3: float
    mean_m: float
    mean_deviation_m: float
    median_m: float


@dataclass(frozen=True)
class BeforeAfter:
    """A layer beside the surface, both times.

    Attributes:
        cells: that the values are of: all that both maps know; heights only where both have plants.
        before, after: median of plant heights [m]; mean of covers (0 to 1). NaN for a part of which
            nothing is known.
    """

    cells: int
    before: float
    after: float


@dataclass(frozen=True)
class PartChange:
    """What changed in a plot or a square.

    Attributes:
        compared_m2: of it, what both maps know [m²]; 0: nothing.
        compared: all of these cells.
        rise, fall: those whose change is more than errors.
        level_m: what the mean change must exceed to be more than errors that all of the part has in
            common [m].
        more_than_errors: it does.
        plant_height, cover: None where a map does not have the layer.
    """

    compared_m2: float
    compared: Share
    rise: Share
    fall: Share
    level_m: float
    more_than_errors: bool
    plant_height: Optional[BeforeAfter]
    cover: Optional[BeforeAfter]


@dataclass(frozen=True)
class ChangedSquare:
    """A square of the field.

    Attributes:
        corner_m: south-west, (x, y), file coordinates [m].
        side_m: [m].
        change: what changed in it.
    """

    corner_m: Tuple[float, float]
    side_m: float
    change: PartChange


@dataclass(frozen=True, eq=False, repr=False)
class Change(Cells):
    """What changed on a field: layers of rows×columns, and what they amount to.

    Row 0 is the southernmost. Floats are NaN where one of the maps knows nothing.

    Attributes:
        height_change_m: float32, of the surface, after less before [m].
        detection_m: float32, level of detection: what the change of an unchanged cell exceeds in 5
            of 100 [m].
        significant: bool, where the change exceeds it.
        plant_height_change_m: float32 [m]; None where a map does not have the layer.
        cover_change: float32, likewise.
        cell_m: side of a cell, of the map with the coarser ones [m].
        file_from_cell: 4×4, (column, row, 0, 1) → file coordinates [m]. Corners of cells are whole
            numbers: the middle of the first one is (0.5, 0.5).
        has_heights: else one of the maps has no surface, and covers alone were compared.
        frame_error_m: heights and places, that was reckoned with [m].
        compared: all cells with a level of detection.
        rise, fall: those whose change exceeds it.
        median_detection_m: of the levels [m].
        bare_ground: what should not have moved: covers below 0.1 both times; None where they do not
            tell.
        plant_height, cover: None where a map does not have the layer.
        plots: those given, by name.
        squares: of which both maps know something.
        warnings: such as bare ground that moved by more than is expected.
        crs: what the file coordinates mean.
    """

    height_change_m: Singles
    detection_m: Singles
    significant: npt.NDArray[np.bool_]
    plant_height_change_m: Optional[Singles]
    cover_change: Optional[Singles]
    cell_m: float
    file_from_cell: Floats
    has_heights: bool
    frame_error_m: Tuple[float, float]
    compared: Share
    rise: Share
    fall: Share
    median_detection_m: float
    bare_ground: Optional[Share]
    plant_height: Optional[BeforeAfter]
    cover: Optional[BeforeAfter]
    plots: Dict[str, PartChange]
    squares: Tuple[ChangedSquare, ...]
    warnings: Tuple[str, ...]
    crs: Crs = Crs()

    @property
    def shape(self) -> Tuple[int, int]:
        """Rows and columns."""
        rows, cols = self.height_change_m.shape
        return rows, cols


def diff(
    map_a: Union[FieldMap, PathLike],
    map_b: Union[FieldMap, PathLike],
    *,
    error_a: Error = None,
    error_b: Error = None,
    frame_error: Error = None,
    plots: Optional[Mapping[str, npt.ArrayLike]] = None,
    grid: float = 0.0,
    threads: int = 0,
    stop: Optional[Stop] = None,
) -> Change:
    """Says what changed between two maps of a field, and what of that is more than their errors.

    They are compared on the grid of the map with the coarser cells, in its corner; the finer map is
    averaged over these cells. As ``agricolmap diff``, whose files of two folders say the same.

    Args:
        map_a: the map before: one that `fuse` returned, the folder of one, or a surface model
            (GeoTIFF) of any program.
        map_b: the map after, likewise.
        error_a, error_b: (heights, places): expected RMS of the map's heights, and of its places, x
            and y together [m], each from 0 to 100; instead of its own. A surface model has none.
        frame_error: the same between the frames of both maps, as of two flights. Nothing is reckoned
            with where it is not said, and a warning tells when it should have been.
        plots: polygons by name, N×2 corners in file coordinates [m], to compare in, too.
        grid: side of squares to compare in, too, on round coordinates, 0.1 to 1000 [m]; 0: none.
        threads, stop: as for `register`.

    Raises:
        InputError: when the maps are in different coordinate systems, do not overlap or know nothing
            in common; when no plot lies where they are compared; for a path that is no map.
        UsageError: for errors, plots and a grid that make no sense; for a surface model without
            errors.
        Interrupted: when `stop` is set.
    """
    handles = map_handle(map_a, "map_a"), map_handle(map_b, "map_b")
    errors = (
        _error(error_a, "error_a"),
        _error(error_b, "error_b"),
        _error(frame_error, "frame_error"),
    )
    named = corners(plots)
    side = _arrays.number(grid, "grid", "a side in metres")
    same = _same_crs(*(handle.crs for handle in handles))
    values = _core.diff(*handles, errors, named, side, same, stop, _arrays.count(threads, "threads"))
    for name in ("compared", "rise", "fall", "bare_ground"):
        values[name] = None if values[name] is None else Share(**values[name])
    for name in ("plant_height", "cover"):
        values[name] = _layer(values[name])
    values["significant"] = values["significant"].astype(np.bool_)
    values["plots"] = {name: _part(part) for (name, _), part in zip(named, values["plots"])}
    values["squares"] = tuple(
        ChangedSquare(corner, width, _part(part)) for corner, width, part in values["squares"]
    )
    values["warnings"] = tuple(values["warnings"])
    known = [handle.crs for handle in handles if handle.crs.wkt]
    crs = Crs(known[0].name, known[0].wkt) if known else Crs()
    return Change(**values, crs=crs)


def _same_crs(one: _core.Crs, other: _core.Crs) -> bool:
    """Whether that is known. As texts of one system differ, GDAL says."""
    if not one.wkt or not other.wkt or one.wkt == other.wkt:
        return False
    try:
        from . import _gdal
    except ImportError:
        return False
    if not _gdal.same_crs(one, other):
        raise InputError(
            f"map_a ({one.name}) and map_b ({other.name}) have different coordinate systems; bring "
            "one into the other's"
        )
    return True


def _error(value: Error, argument: str) -> Optional[Tuple[float, float]]:
    if value is None:
        return None
    needs = "two numbers: the RMS of heights and of places, in metres"
    array = _arrays.numbers(value, argument, needs)
    if array.shape != (2,):
        raise UsageError(f"{argument}: has shape {array.shape}; give {needs}")
    return float(array[0]), float(array[1])


def _layer(values: Optional[Dict[str, Any]]) -> Optional[BeforeAfter]:
    return None if values is None else BeforeAfter(**values)


def _part(values: Dict[str, Any]) -> PartChange:
    shares = {name: Share(**values[name]) for name in ("compared", "rise", "fall")}
    layers = {name: _layer(values[name]) for name in ("plant_height", "cover")}
    return PartChange(**{**values, **shares, **layers})
