"""One map of a field from a drone's cloud and the strips that were laid into it."""

from __future__ import annotations

import datetime
from dataclasses import dataclass
from typing import Any, Callable, Iterable, List, Mapping, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Bytes, Floats, PathLike
from ._cloud import Cloud, CloudLike, Crs, cloud_of
from ._errors import UsageError
from ._maps import Cells
from ._options import OptionInfo, flat_texts, infos_of
from ._register import Stop
from ._result import Registration

Singles = npt.NDArray[np.float32]
Date = Union[None, int, datetime.date]


@dataclass(frozen=True)
class Strip:
    """A strip that lies in the fixed cloud's coordinates; `of` makes one of a registration.

    Attributes:
        name: what it is called in the map.
        cloud: in the fixed cloud's coordinates.
        plane_error_m: expected RMS in the plane [m]; 1 m where nobody knows.
        height_error_m: expected RMS of the heights [m].
        heights_limited: its heights say nothing of the fixed cloud's.
        date: of the drive: of two strips that saw a cell the later one has it.
    """

    name: str
    cloud: Cloud
    plane_error_m: float = 1.0
    height_error_m: float = 1.0
    heights_limited: bool = False
    date: Date = None

    @classmethod
    def of(
        cls,
        name: str,
        moving: CloudLike,
        result: Registration,
        *,
        date: Date = None,
        force: bool = False,
    ) -> "Strip":
        """The moving cloud where the registration lays it, with the errors that it states.

        Raises:
            UsageError: for a registration that was not accepted, unless it is forced, and for one
                without a transformation.
        """
        if not result.accepted and not force:
            raise UsageError(
                f"{name}: its registration is {result.status}: {'; '.join(result.reasons)} "
                "(force=True takes it nevertheless)"
            )
        handle, plane, height, limited = _core.laid_strip(
            cloud_of(moving, "moving", result.crs)._handle, result._handle
        )
        return cls(name, Cloud._of(handle), plane, height, limited, date)


@dataclass(frozen=True, eq=False, repr=False)
class FineCells(Cells):
    """What a strip shows in cells of its own, finer than the map's, where it owns those.

    Row 0 is the southernmost. Floats are NaN where the strip shows nothing, or another has the cell.

    Attributes:
        plant_height_m: rows×columns float32, above the map's ground [m].
        excess_green: rows×columns float32, chromatic.
        cover: rows×columns float32, 0 to 1.
        density: rows×columns float32, points per m².
        cell_m: side of a cell [m].
        file_from_cell: 4×4, (column, row, height above the map's zero [m], 1) → file coordinates
            [m]. Corners of cells are whole numbers.
        crs: what the file coordinates mean.
    """

    plant_height_m: Singles
    excess_green: Singles
    cover: Singles
    density: Singles
    cell_m: float
    file_from_cell: Floats
    crs: Crs = Crs()


@dataclass(frozen=True, eq=False)
class FusedStrip:
    """What became of a strip.

    Attributes:
        name: as it was given.
        source: its number in the layer of that name.
        moved_m: (3,), to agree with strips that overlap it [m].
        seen_m2: what it saw [m²].
        owned_m2: what it has in the map [m²].
        fine: that in its own cells; None where it has nothing.
    """

    name: str
    source: int
    moved_m: Floats
    seen_m2: float
    owned_m2: float
    fine: Optional[FineCells] = None


@dataclass(frozen=True, eq=False, repr=False)
class FieldMap(Cells):
    """What a map says of every cell of a field: layers of rows×columns.

    Row 0 is the southernmost. Floats are NaN where nothing is known.

    Attributes:
        surface_m: height of the surface, above the map's zero [m] (see `file_from_cell`).
        ground_m: the same of the ground.
        plant_height_m: surface less ground [m].
        excess_green: chromatic.
        cover: share of the cell that is vegetation, 0 to 1.
        density: points per m².
        plane_error_m: expected RMS, against the fixed cloud [m].
        height_error_m: expected RMS of the surface [m].
        colour: rows×columns×3 uint8.
        source: uint16: 0 nothing, 1 the fixed cloud, else a strip's number.
        date: int32, YYYYMMDD; 0: nobody said.
        has_heights: else the layers of heights are all NaN.
        strips: what became of each.
        warnings: such as strips that lie apart where they overlap.
        cell_m: side of a cell [m].
        file_from_cell: 4×4, (column, row, surface or ground [m], 1) → file coordinates [m].
            Corners of cells are whole numbers: the middle of the first one is (0.5, 0.5).
        crs: what the file coordinates mean.
    """

    surface_m: Singles
    ground_m: Singles
    plant_height_m: Singles
    excess_green: Singles
    cover: Singles
    density: Singles
    plane_error_m: Singles
    height_error_m: Singles
    colour: Bytes
    source: npt.NDArray[np.uint16]
    date: npt.NDArray[np.int32]
    has_heights: bool
    strips: Tuple[FusedStrip, ...]
    warnings: Tuple[str, ...]
    cell_m: float
    file_from_cell: Floats
    crs: Crs = Crs()
    _handle: Optional[_core.FieldMap] = None

    @classmethod
    def read(cls, path: PathLike) -> "FieldMap":
        """A map as ``agricolmap fuse`` wrote it, by its folder, or a surface model of any program.

        Layers that it does not have are NaN: of a surface model (GeoTIFF) all others, and its
        errors. Surface and ground are as high as the files say.

        Raises:
            InputError: for what is no such map, or a damaged one.
            UsageError: in a build without GDAL.
        """
        text = _arrays.path_of(path, "path")
        try:
            from . import _gdal
        except ImportError:
            raise UsageError(
                "path: this build has no GDAL, which maps on the disk need (AGRICOLMAP_WITH_GDAL)"
            ) from None
        handle = _gdal.read_field_map(text)
        return cls._of(handle, Crs(handle.crs.name, handle.crs.wkt))

    @classmethod
    def _of(cls, handle: _core.FieldMap, crs: Crs) -> "FieldMap":
        values = handle.values()
        strips = []
        for name, source, moved, seen, owned, fine in values["strips"]:
            cells = None if fine is None else FineCells(**fine, crs=crs)
            strips.append(FusedStrip(name, source, moved, seen, owned, cells))
        values["strips"] = tuple(strips)
        values["warnings"] = tuple(values["warnings"])
        return cls(**values, crs=crs, _handle=handle)


def fuse_options() -> List[OptionInfo]:
    """The options of `fuse`."""
    return infos_of(_core.fuse_options())


def fuse(
    fixed: CloudLike,
    strips: Iterable[Strip],
    options: Optional[Mapping[str, Any]] = None,
    *,
    date: Date = None,
    progress: Optional[Callable[[str], Any]] = None,
    threads: int = 0,
    stop: Optional[Stop] = None,
) -> FieldMap:
    """Makes one map of the drone's cloud and the strips that were laid into it.

    Strips' cells replace the fixed cloud's where strips have seen; its heights are led to theirs,
    and corrected over plants as strips show. The order of the strips does not count.

    Args:
        fixed: as for `register`: the cloud that the strips were registered to.
        strips: see `Strip.of`.
        options: by name, nested or with dots; `fuse_options` lists them.
        date: of the flight.
        progress, threads, stop: as for `register`.

    Raises:
        InputError: when a strip does not touch the fixed cloud.
        UsageError: for options, without strips, and for two of one name.
        Interrupted: when `stop` is set.
    """
    cloud = cloud_of(fixed, "fixed")
    given = [
        (
            strip.name,
            strip.cloud._handle,
            float(strip.plane_error_m),
            float(strip.height_error_m),
            bool(strip.heights_limited),
            _day(strip.date, f"{strip.name}: date"),
        )
        for strip in strips
    ]
    handle = _core.fuse(
        cloud._handle,
        given,
        flat_texts(options or {}),
        _day(date, "date"),
        progress,
        stop,
        _arrays.count(threads, "threads"),
    )
    return FieldMap._of(handle, cloud.crs)


def _day(value: Date, argument: str) -> int:
    """As YYYYMMDD; 0: nobody said."""
    if value is None:
        return 0
    if isinstance(value, datetime.date):
        return int(value.strftime("%Y%m%d"))
    try:
        datetime.datetime.strptime(str(value), "%Y%m%d")
    except ValueError:
        raise UsageError(f"{argument}: is {value!r}; give a datetime.date or YYYYMMDD") from None
    return int(value)


def map_handle(value: Any, argument: str) -> _core.FieldMap:
    """What the library knows a map by; a path is read."""
    if _arrays.is_path(value):
        value = FieldMap.read(value)
    handle = value._handle if isinstance(value, FieldMap) else None
    if handle is None:
        raise UsageError(f"{argument}: is no map that fuse returned, and no path of one")
    return handle


def corners(plots: Optional[Mapping[str, npt.ArrayLike]]) -> List[Tuple[str, Floats]]:
    """Polygons by name, each N×2 corners in file coordinates [m]."""
    needs = "three corners or more as x, y in metres, shape (N, 2)"
    named = []
    for name, value in (plots or {}).items():
        array = _arrays.numbers(value, f"plots[{name!r}]", needs)
        if array.ndim != 2 or array.shape[1] != 2 or len(array) < 3:
            raise UsageError(f"plots[{name!r}]: has shape {array.shape}; give {needs}")
        if not np.isfinite(array).all():
            raise UsageError(f"plots[{name!r}]: has a corner that is not finite; give {needs}")
        named.append((str(name), np.ascontiguousarray(array, dtype=np.float64)))
    return named
