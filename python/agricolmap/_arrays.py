"""Arrays that callers give, checked: a message names the argument, what it has and what it needs."""

from __future__ import annotations

import operator
import os
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from ._errors import UsageError

PathLike = Union[str, "os.PathLike[str]"]
Floats = npt.NDArray[np.float64]
Bytes = npt.NDArray[np.uint8]


def is_path(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def path_of(value: Any, argument: str) -> str:
    if not is_path(value):
        raise UsageError(f"{argument}: is a {type(value).__name__}; give the path of a file")
    text: str = os.fspath(value)
    return text


def as_array(value: Any, argument: str) -> npt.NDArray[Any]:
    try:
        return np.asarray(value)
    except ValueError as error:
        raise UsageError(f"{argument}: is no array: {error}") from None


def numbers(value: Any, argument: str, needs: str) -> npt.NDArray[Any]:
    array = as_array(value, argument)
    if array.dtype.kind not in "fiu":
        raise UsageError(f"{argument}: has dtype {array.dtype}; give {needs}")
    return array


def number(value: Any, argument: str, needs: str) -> float:
    """One of them, and finite."""
    array = numbers(value, argument, f"a number: {needs}")
    if array.ndim != 0 or not np.isfinite(array):
        raise UsageError(f"{argument}: is {value!r}; give a number: {needs}")
    return float(array)


def points(value: Any, argument: str) -> Floats:
    """N×3 coordinates as float64, one row per point."""
    needs = "coordinates x, y, z in metres as float64, shape (N, 3)"
    array = numbers(value, argument, needs)
    if array.ndim != 2 or array.shape[1] != 3:
        turned = " (transposed?)" if array.ndim == 2 and array.shape[0] == 3 else ""
        raise UsageError(f"{argument}: has shape {array.shape}{turned}; give {needs}")
    return np.ascontiguousarray(array, dtype=np.float64)


def colours(value: Any, argument: str, count: int) -> Bytes:
    """N×3 colours as uint8, one row per point."""
    needs = f"red, green, blue from 0 to 255 as uint8, shape ({count}, 3)"
    array = as_array(value, argument)
    if array.dtype != np.uint8:
        remedy = ""
        if array.dtype.kind == "f":
            remedy = ": of colours from 0 to 1 (255 * colours).round().astype(numpy.uint8)"
        elif array.dtype == np.uint16:
            remedy = ": of 16 bits (colours // 257).astype(numpy.uint8)"
        raise UsageError(f"{argument}: has dtype {array.dtype}; give {needs}{remedy}")
    if array.shape != (count, 3):
        raise UsageError(f"{argument}: has shape {array.shape}; give {needs}")
    return np.ascontiguousarray(array)


def matrix(value: Any, argument: str) -> Floats:
    """A 4×4 affine transformation."""
    needs = "an affine transformation: 4 x 4 numbers, the last row 0 0 0 1"
    array = numbers(value, argument, needs)
    if array.shape != (4, 4):
        raise UsageError(f"{argument}: has shape {array.shape}; give {needs}")
    affine = np.ascontiguousarray(array, dtype=np.float64)
    if not np.isfinite(affine).all():
        raise UsageError(f"{argument}: has numbers that are not finite; give {needs}")
    if not np.array_equal(affine[3], [0.0, 0.0, 0.0, 1.0]):
        raise UsageError(f"{argument}: its last row is {affine[3].tolist()}; give {needs}")
    if np.linalg.matrix_rank(affine[:3, :3]) < 3:
        raise UsageError(f"{argument}: is not invertible; give {needs}")
    return affine


def moved(affine: Floats, at: Floats) -> Floats:
    """N×3 points after the transformation."""
    result: Floats = at @ affine[:3, :3].T + affine[:3, 3]
    return result


def count(value: Any, argument: str) -> int:
    """A number of things: whole and not negative."""
    try:
        number = operator.index(value)
    except TypeError:
        raise UsageError(f"{argument}: is {value!r}; give a whole number") from None
    if not 0 <= number < 2**31:
        raise UsageError(f"{argument}: is {value!r}; give a number from 0 on")
    return number
