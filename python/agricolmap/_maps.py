"""Clouds as maps of cells: arrays with their georeference."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any, Dict, Mapping, Optional, Tuple, TypeVar, Union, cast

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Bytes, Floats, PathLike
from ._cloud import CloudLike, Crs, cloud_of
from ._errors import UsageError
from ._options import Options, options_of

_Map = TypeVar("_Map", bound="Cells")


class Cells:
    """Where the cells of a map lie."""

    excess_green: npt.NDArray[np.float32]
    cell_m: float
    file_from_cell: Floats

    @property
    def shape(self) -> Tuple[int, int]:
        """Rows and columns."""
        rows, cols = self.excess_green.shape
        return rows, cols

    @property
    def affine(self) -> Tuple[float, float, float, float, float, float]:
        """(a, b, c, d, e, f) as ``affine.Affine(*...)`` and rasterio take it, on the ground.

        x = a·column + b·row + c, y = d·column + e·row + f, of the cells' corners [m].
        """
        (a, b, _, c), (d, e, _, f) = self.file_from_cell[:2].tolist()
        return a, b, c, d, e, f

    def centres(self) -> Tuple[Floats, Floats]:
        """x and y of the cells' middles on the ground, each rows×columns [m]."""
        rows, cols = self.shape
        a, b, c, d, e, f = self.affine
        col, row = np.meshgrid(np.arange(cols) + 0.5, np.arange(rows) + 0.5)
        return a * col + b * row + c, d * col + e * row + f

    def cells_of(self, xy: npt.ArrayLike) -> Floats:
        """Where points lie in the map: N×2 (column, row) of N×2 or N×3 file coordinates [m].

        ``numpy.floor`` of them are the indices ``[row, column]``.
        """
        needs = "coordinates in metres, shape (N, 2) or (N, 3)"
        at = _arrays.numbers(xy, "xy", needs)
        if at.ndim != 2 or at.shape[1] not in (2, 3):
            raise UsageError(f"xy: has shape {at.shape}; give {needs}")
        a, b, c, d, e, f = self.affine
        cells: Floats = np.linalg.solve([[a, b], [d, e]], (at[:, :2] - [c, f]).T).T
        return cells

    def north_up(self: _Map) -> _Map:
        """The same with the northernmost row first, as pictures and most rasters have it."""
        rows, _ = self.shape
        turned = np.eye(4)
        turned[1, 1], turned[1, 3] = -1.0, rows
        layers = {
            layer.name: getattr(self, layer.name)[::-1]
            for layer in fields(cast(Any, self))
            if layer.name != "file_from_cell"
            and getattr(getattr(self, layer.name), "shape", ())[:2] == self.shape
        }
        made: _Map = replace(
            cast(Any, self), **layers, file_from_cell=self.file_from_cell @ turned
        )
        return made

    def __repr__(self) -> str:
        rows, cols = self.shape
        kind = type(self).__name__
        return f"<agricolmap.{kind} {rows} rows x {cols} columns of {self.cell_m:g} m>"


@dataclass(frozen=True, eq=False, repr=False)
class CellMap(Cells):
    """A cloud seen along its ground's normal, in square cells.

    Row 0 is the southernmost where the map lies as its file does; `north_up` turns that. Where no
    point fell, floats are NaN, colours black and the weight 0.

    Attributes:
        height_m: rows×columns float32, mean height above the ground plane [m].
        excess_green: rows×columns float32, mean; all NaN for a cloud without colours.
        colour: rows×columns×3 uint8, mean.
        weight: rows×columns float32, points that a cell's values rest on.
        cell_m: side of a cell [m].
        file_from_cell: 4×4, (column, row, height above the ground [m], 1) → file coordinates [m].
            Corners of cells are whole numbers: the middle of the first one is (0.5, 0.5).
        crs: what the file coordinates mean.
    """

    height_m: npt.NDArray[np.float32]
    excess_green: npt.NDArray[np.float32]
    colour: Bytes
    weight: npt.NDArray[np.float32]
    cell_m: float
    file_from_cell: Floats
    crs: Crs = Crs()


def map_of(values: Dict[str, Any], crs: Crs) -> CellMap:
    return CellMap(**values, crs=crs)


def map_cloud(
    cloud: CloudLike,
    options: Optional[Union[Options, Mapping[str, Any], PathLike]] = None,
    *,
    stop: Optional[Any] = None,
    threads: int = 0,
) -> CellMap:
    """The stages level and grid alone: the whole of a cloud as a map, in its file's coordinates.

    Args:
        cloud: a `Cloud`, a path or arrays, as for `register`.
        options: those of the groups ``level`` and ``grid`` count.
        stop, threads: as for `register`.

    Raises:
        InputError: for clouds that cannot be used.
        UsageError: for options that make no sense.
    """
    points = cloud_of(cloud, "cloud")
    chosen = options_of(options)
    values = _core.map_cloud(points._handle, chosen._handle, stop, _arrays.count(threads, "threads"))
    return map_of(values, points.crs)
