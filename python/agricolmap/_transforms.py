"""Transformations and paths from and to files."""

from __future__ import annotations

import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, PathLike


def read_matrix(path: PathLike) -> Floats:
    """Reads a transformation: 4×4 float64.

    16 numbers, row-major, last row 0 0 0 1; commas, brackets and ``#`` comments are fine, and so is
    PDAL's JSON.

    Raises:
        InputError: names file and place.
    """
    return _core.read_matrix(_arrays.path_of(path, "path"))


def write_matrix(path: PathLike, transform: npt.ArrayLike) -> None:
    """Writes a 4×4 transformation with 17 digits: what is read back is the same to the bit.

    Raises:
        OutputError: when it cannot be written.
    """
    _core.write_matrix(_arrays.path_of(path, "path"), _arrays.matrix(transform, "transform"))


def read_path(path: PathLike) -> Floats:
    """Reads the places of a robot in order of driving: M×3 float64 [m].

    Lines ``x y``, ``x y z``, ``t x y z`` or TUM's ``t x y z qx qy qz qw``, or columns under a line
    of names.

    Raises:
        InputError: names file and place.
    """
    return _core.read_path(_arrays.path_of(path, "path"))
