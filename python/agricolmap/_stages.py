"""The stages of a registration one by one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterable, List, Mapping, Optional, Tuple, Union

import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, PathLike
from ._cloud import CloudLike, kept, pair_of
from ._errors import UsageError
from ._maps import CellMap, map_of
from ._options import Options, options_of
from ._register import Stop, guess_of
from ._result import Registration, registration_of


@dataclass(frozen=True, eq=False)
class Place:
    """Where the moving cloud may lie.

    Attributes:
        transform: 4×4, moving → fixed file coordinates [m].
        score: larger is better; comparable among the places of one call.
    """

    transform: Floats
    score: float = 0.0


#: What stands for a place: a `Place` or its 4×4 transformation.
PlaceLike = Union[Place, npt.ArrayLike]


class Pair:
    """Two clouds levelled, drawn as maps and made comparable: the stages level, grid and signals.

    For those who look between the stages, or bring places of their own; `register` runs them all,
    searches again where the first search does not convince, and places long strips piece by piece.
    Several threads may use one pair.

    Args:
        fixed, moving, guess, options, threads, stop: as for `register`.

    Raises:
        InputError, UsageError, Interrupted: as `register` does, and UsageError where the scale of
            the moving cloud is unknown.
    """

    def __init__(
        self,
        fixed: CloudLike,
        moving: CloudLike,
        guess: Optional[Union[npt.ArrayLike, PathLike]] = None,
        options: Optional[Union[Options, Mapping[str, Any], PathLike]] = None,
        threads: int = 0,
        *,
        stop: Optional[Stop] = None,
    ) -> None:
        chosen = options_of(options)
        self._threads = _arrays.count(threads, "threads")
        self._stop = stop
        affine, self._warnings = guess_of(guess, fixed, moving)
        first, second = pair_of(fixed, moving)
        self._crs = first.crs
        self._clouds = kept((fixed, moving), (first, second))
        self._handle = _core.make_pair(
            first._handle, second._handle, affine, chosen._handle, stop, self._threads
        )

    def maps(self) -> Tuple[CellMap, CellMap]:
        """What is compared: the fixed map, and the moving one where the guess lays it."""
        fixed, moving = self._handle.maps()
        return map_of(fixed, self._crs), map_of(moving, self._crs)

    def locate(self) -> List[Place]:
        """The stage locate: places within the prior's limits, best first.

        None where nothing coherent was found.
        """
        return [Place(*place) for place in self._handle.locate(self._stop, self._threads)]

    def refine(self, places: Iterable[PlaceLike]) -> List[Place]:
        """The stage refine: the places that hold, led on to the finest cells, best first.

        What ran to one and the same place is one.
        """
        refined = self._handle.refine(_scored(places), self._stop, self._threads)
        return [Place(*place) for place in refined]

    def judge(self, places: Iterable[PlaceLike]) -> Registration:
        """The stages from refine to compose: the best of the places, judged beside the others.

        Of a single one nothing is known of rivals; decoys are looked for all the same.
        """
        handle = self._handle.judge(_scored(places), self._stop, self._threads)
        return registration_of(handle, self._crs, self._warnings, self._clouds)


def _scored(places: Iterable[PlaceLike]) -> List[Tuple[Floats, float]]:
    if isinstance(places, Place) or getattr(places, "ndim", 3) == 2:
        raise UsageError("places: is a single one; give a list of them")
    return [
        (_arrays.matrix(place.transform, f"places[{i}]"), float(place.score))
        if isinstance(place, Place)
        else (_arrays.matrix(place, f"places[{i}]"), 0.0)
        for i, place in enumerate(places)
    ]
