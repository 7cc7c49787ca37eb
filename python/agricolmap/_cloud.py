"""Coloured point clouds, from arrays and files and back."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Bytes, Floats, PathLike
from ._errors import UsageError


@dataclass(frozen=True)
class Crs:
    """What coordinates mean on the Earth.

    Attributes:
        name: such as ``"WGS 84 / UTM zone 32N"``; empty where nobody said.
        wkt: its whole definition as OGC WKT, as pyproj and rasterio take it.
    """

    name: str = ""
    wkt: str = ""

    def __bool__(self) -> bool:
        return bool(self.wkt)


class Cloud:
    """Points in metres with their colours; cannot be changed.

    Args:
        xyz: N×3, any real dtype (float64 for large coordinates such as UTM): x and y horizontal, z
            up, in metres. Points with a NaN, an infinity or a coordinate beyond 1e8 m are left out,
            and so are those far from all others.
        colours: N×3 uint8, red, green, blue from 0 to 255; None: a cloud without colours.
        name: stands for the cloud in messages.
        crs: what the coordinates mean; kept for what is written.

    Raises:
        UsageError: for arrays of another shape or dtype.
        InputError: when no point can be used.
    """

    __slots__ = ("_handle",)
    _handle: _core.Cloud

    def __init__(
        self,
        xyz: npt.ArrayLike,
        colours: Optional[npt.ArrayLike] = None,
        *,
        name: str = "points",
        crs: Optional[Crs] = None,
    ) -> None:
        at = _arrays.points(xyz, "xyz")
        rgb = None if colours is None else _arrays.colours(colours, "colours", len(at))
        said = crs or Crs()
        self._handle = _core.make_cloud(
            at, rgb, name, _core.Crs(said.name, said.wkt), _precision_warnings(xyz, at, name)
        )

    @classmethod
    def _of(cls, handle: _core.Cloud) -> "Cloud":
        cloud = cls.__new__(cls)
        cloud._handle = handle
        return cloud

    @property
    def xyz(self) -> Floats:
        """N×3 float64, coordinates as in the cloud's file [m]; a new array each time."""
        return self._handle.file_points()

    @property
    def local_xyz(self) -> npt.NDArray[np.float32]:
        """N×3 float32, ``xyz - origin`` [m]; the cloud's own memory, which cannot be written to."""
        return self._handle.local_points()

    @property
    def origin(self) -> Floats:
        """What ``local_xyz`` is counted from: (3,), coordinates as in the cloud's file [m]."""
        return self._handle.origin

    @property
    def colours(self) -> Optional[Bytes]:
        """N×3 uint8, or None; the cloud's own memory, which cannot be written to."""
        return self._handle.colours()

    @property
    def name(self) -> str:
        """What it is called in messages: the file that it was read from."""
        return self._handle.name

    @property
    def crs(self) -> Crs:
        """What the coordinates mean; false where nobody said."""
        return Crs(self._handle.crs.name, self._handle.crs.wkt)

    @property
    def fields(self) -> str:
        """What its file has of each point, such as ``"x, y, z, intensity"``."""
        return self._handle.fields

    @property
    def dropped_points(self) -> int:
        """How many points were left out: not finite or far off."""
        return self._handle.dropped_points

    @property
    def warnings(self) -> Tuple[str, ...]:
        """What was odd about it."""
        return tuple(self._handle.warnings)

    def write(self, path: PathLike, transform: Optional[npt.ArrayLike] = None) -> None:
        """Writes the cloud, after moving it where a transformation is given.

        Coordinates and colours alone; ``.ply``, ``.pcd``, ``.las``, ``.laz`` or ``.copc.laz`` by the
        ending. An existing file is replaced.

        Args:
            path: the file.
            transform: 4×4, coordinates of this cloud → those of the file.

        Raises:
            OutputError: when it cannot be written.
            UsageError: for another ending, or LAZ in a build without LASzip.
        """
        moved = np.eye(4) if transform is None else _arrays.matrix(transform, "transform")
        _core.write_cloud(_arrays.path_of(path, "path"), self._handle, moved)

    def __len__(self) -> int:
        return len(self._handle)

    def __repr__(self) -> str:
        kind = "coloured points" if self.colours is not None else "points without colours"
        return f"<agricolmap.Cloud {self.name!r}: {len(self)} {kind}>"


#: What functions take for a cloud: a `Cloud`, the path of a file, the paths of an orthomosaic and
#: its surface model, coordinates N×3, or coordinates and colours.
CloudLike = Union[Cloud, PathLike, Tuple[Any, Any], npt.ArrayLike]


def _precision_warnings(given: Any, at: Floats, name: str) -> list[str]:
    """That single precision has cost millimetres already."""
    dtype = getattr(given, "dtype", None)
    if dtype not in (np.dtype(np.float32), np.dtype(np.float16)) or not len(at):
        return []
    largest = np.nanmax(np.abs(at), initial=0.0, where=np.isfinite(at))
    step = float(np.spacing(dtype.type(largest)))
    if step < 0.001:
        return []
    return [
        f"{name}: coordinates up to {largest:.0f} m came as {dtype}, which has steps of "
        f"{100.0 * step:.2g} cm there; give float64"
    ]


def _is_pair_of_paths(value: Any) -> bool:
    return isinstance(value, tuple) and len(value) == 2 and all(map(_arrays.is_path, value))


def _is_file(value: Any) -> bool:
    return _arrays.is_path(value) or _is_pair_of_paths(value)


def _file_text(value: Any, argument: str) -> str:
    if _is_pair_of_paths(value):
        return ",".join(os.fspath(path) for path in value)
    return _arrays.path_of(value, argument)


def _read_text(text: str, crs: str = "", target: str = "", beside: Optional[Crs] = None) -> Cloud:
    """A file in its own system, in `target`, or as the moving one of a pair in that of `beside`."""
    try:
        from . import _gdal
    except ImportError:
        if crs or target:
            raise UsageError(
                "crs: this build has no GDAL, which coordinate systems need (AGRICOLMAP_WITH_GDAL)"
            ) from None
        return Cloud._of(_core.read_cloud(text))
    if beside is not None:
        return Cloud._of(_gdal.read_beside(_core.Crs(beside.name, beside.wkt), text))
    return Cloud._of(_gdal.read_map(text, crs, target))


def read(
    path: Union[PathLike, Tuple[PathLike, PathLike]], *, crs: str = "", target_crs: str = ""
) -> Cloud:
    """Reads a cloud: LAS, LAZ, COPC, PLY, PCD or lines of text, told apart by content.

    Args:
        path: the file, or an orthomosaic, or the two paths of an orthomosaic and its surface model
            (GeoTIFFs), of which each pixel becomes a point.
        crs: what the coordinates mean, where neither the file nor a ``.prj`` beside it says:
            ``"EPSG:32632"``, WKT, or a file with one of these. Feet become metres.
        target_crs: the same, into which the cloud is brought; else it stays in its own.

    Raises:
        InputError: names file, place and reason when the file is not what its header says.
        UsageError: for a coordinate system that is not understood or not in metres.
    """
    return _read_text(_file_text(path, "path"), crs, target_crs)


def cloud_of(value: Any, argument: str, beside: Optional[Crs] = None) -> Cloud:
    """The cloud that `value` stands for; files are read as the moving one of a pair."""
    if isinstance(value, Cloud):
        return value
    if _is_file(value):
        return _read_text(_file_text(value, argument), beside=beside)
    xyz, colours = value, None
    if isinstance(value, tuple) and len(value) == 2:
        xyz, colours = value
    at = _arrays.points(xyz, argument)
    rgb = None if colours is None else _arrays.colours(colours, f"{argument}[1]", len(at))
    warnings = _precision_warnings(xyz, at, argument)
    return Cloud._of(_core.make_cloud(at, rgb, argument, _core.Crs("", ""), warnings))


def _require_one_frame(fixed: Cloud, moving: Cloud) -> None:
    """Two systems of two names; what nobody said, or said in other words, is taken as it stands."""
    names = fixed.crs.name, moving.crs.name
    if all(names) and names[0] != names[1]:
        raise UsageError(
            f"moving: is in {names[1]}, and fixed in {names[0]}; bring it there by "
            "read(path, target_crs=fixed.crs.wkt), or give its file"
        )


def pair_of(fixed: Any, moving: Any) -> Tuple[Cloud, Cloud]:
    """Both clouds in one frame: that of the fixed one."""
    if not (_is_file(fixed) and _is_file(moving)):
        first = cloud_of(fixed, "fixed")
        second = cloud_of(moving, "moving", first.crs)
        _require_one_frame(first, second)
        return first, second
    try:
        from . import _gdal
    except ImportError:
        return cloud_of(fixed, "fixed"), cloud_of(moving, "moving")
    pair = _gdal.read_pair(_file_text(fixed, "fixed"), "", _file_text(moving, "moving"), "")
    return Cloud._of(pair[0]), Cloud._of(pair[1])


def kept(given: Tuple[Any, Any], clouds: Tuple[Cloud, Cloud]) -> Tuple[Any, Any]:
    """What `pair_of` makes the same clouds of again: of files their names, which take no memory."""
    first, second = (
        value if _is_file(value) else cloud for value, cloud in zip(given, clouds)
    )
    return first, second
