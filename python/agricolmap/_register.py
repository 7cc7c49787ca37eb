"""The registration: from two clouds and an initial guess to a transformation and a verdict."""

from __future__ import annotations

from typing import Any, Callable, List, Mapping, Optional, Protocol, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, PathLike
from ._cloud import CloudLike, kept, pair_of
from ._errors import UsageError
from ._options import Options, options_of
from ._result import Registration, registration_of


class Stop(Protocol):
    """What asks to stop: ``threading.Event`` does."""

    def is_set(self) -> bool:
        """Whether to stop."""
        ...


def register(
    fixed: CloudLike,
    moving: CloudLike,
    guess: Optional[Union[npt.ArrayLike, PathLike]] = None,
    options: Optional[Union[Options, Mapping[str, Any], PathLike]] = None,
    path: Optional[Union[npt.ArrayLike, PathLike]] = None,
    progress: Optional[Callable[[str], Any]] = None,
    threads: int = 0,
    *,
    stop: Optional[Stop] = None,
) -> Registration:
    """Finds the transformation that lays `moving` (the robot's cloud) into `fixed` (the drone's).

    The interpreter is free for other threads meanwhile, and Ctrl-C stops. A registration that fails
    is a rejected result, not an exception.

    Args:
        fixed, moving: a `Cloud`; the path of a file (LAS, LAZ, COPC, PLY, PCD, text), or the two
            paths of an orthomosaic and its surface model; coordinates N×3 [m]; or the coordinates
            and N×3 uint8 colours. z points up to within 45°. Two files are brought into the
            coordinate system of the first; `read` says it where they do not.
        guess: 4×4, moving → fixed file coordinates [m], as wrong as ``options.prior`` allows; or
            the file of one. None: by ``offset.xyz`` beside the two files; else the coordinates as
            they stand.
        options: an `Options`, a dict of them (nested or with dots; ``"preset"`` names another
            preset), or the path of a YAML file. None: the default preset.
        path: M×3 or M×2, where the robot drove, in order, moving file coordinates [m]; or the file
            of it. It serves long strips whose shape does not tell it.
        progress: called with the name of each stage when it begins, from this thread. What it
            raises stops the registration and is raised.
        threads: at most so many; 0: all cores. The result does not depend on it.
        stop: a ``threading.Event``, say: when it is set, `Interrupted` is raised soon after.

    Raises:
        InputError: for clouds that cannot be used.
        UsageError: for arguments of another shape or dtype, and options that make no sense beside
            one another or would do nothing.
        Interrupted: when `stop` is set.
    """
    if progress is not None and not callable(progress):
        raise UsageError("progress: cannot be called; give a function of the stage's name")
    if stop is not None and not hasattr(stop, "is_set"):
        raise UsageError("stop: has no is_set(); give a threading.Event")
    chosen = options_of(options)
    at_most = _arrays.count(threads, "threads")
    places = _path(path)
    affine, warnings = guess_of(guess, fixed, moving)
    first, second = pair_of(fixed, moving)
    handle = _core.register(
        first._handle, second._handle, affine, chosen._handle, places, progress, stop, at_most
    )
    return registration_of(
        handle, first.crs, warnings, kept((fixed, moving), (first, second))
    )


def _path(path: Any) -> Floats:
    if path is None:
        return np.empty((0, 3))
    if _arrays.is_path(path):
        return _core.read_path(path)
    array = _arrays.as_array(path, "path")
    if array.ndim == 2 and array.shape[1] == 2:
        array = np.column_stack([array, np.zeros(len(array))])
    return _arrays.points(array, "path")


def guess_of(guess: Any, fixed: Any, moving: Any) -> Tuple[Floats, List[str]]:
    """The guess, and what its caller should know of how it was come by."""
    if _arrays.is_path(guess):
        return _core.read_matrix(guess), []
    if guess is not None:
        return _arrays.matrix(guess, "guess"), []
    files = [value for value in (fixed, moving) if _arrays.is_path(value)]
    if len(files) != 2:
        return np.eye(4), []
    offsets = [_core.read_offset_beside(file) for file in files]
    warnings = []
    known = [file for file, offset in zip(files, offsets) if offset is not None]
    if len(known) == 1:
        other = files[0] if known[0] is files[1] else files[1]
        warnings.append(
            f"only {known[0]} has an offset.xyz; {other} is taken to be in world coordinates already"
        )
    world_from_fixed, world_from_moving = (
        np.eye(4) if offset is None else offset for offset in offsets
    )
    return np.linalg.solve(world_from_fixed, world_from_moving), warnings
