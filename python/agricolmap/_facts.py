"""What stands on a field: rows, plants, gaps, weeds, heights."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, Optional, Tuple, Union, cast

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, PathLike
from ._cloud import CloudLike, cloud_of
from ._field import FieldMap, corners, map_handle
from ._options import OptionInfo, flat_texts, infos_of
from ._register import Stop

Integers = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Stand:
    """What stands on a field, or a part of it.

    Attributes:
        area_m2: that the map shows [m²].
        cover: share of it that is green.
        weeds: share of what is between rows that is under weeds.
        patches: of weeds.
        row_length_m: [m].
        plants: expected, and one per spacing where they cannot be told apart.
        plants_low, plants_high: hold the truth nine times in ten, on simulated fields.
        counted: plants told apart.
        uncounted_m: of the rows, where they cannot be [m].
        gaps: of 1.5 spacings and more.
        gap_length_m: of these [m].
        height_low_m, height_middle_m, height_high_m: that a tenth, half and nine tenths of the
            plants are below [m]; NaN where not known.
    """

    area_m2: float
    cover: float
    weeds: float
    patches: int
    row_length_m: float
    plants: float
    plants_low: float
    plants_high: float
    counted: int
    uncounted_m: float
    gaps: int
    gap_length_m: float
    height_low_m: float
    height_middle_m: float
    height_high_m: float


@dataclass(frozen=True, eq=False)
class Row:
    """A row of plants.

    Attributes:
        line: N×2, file coordinates [m].
        stand: what stands in it.
    """

    line: Floats
    stand: Stand


@dataclass(frozen=True)
class Square:
    """A part of the field.

    Attributes:
        corner_m: south-west, (x, y), file coordinates [m].
        side_m: [m].
        stand: what stands in it.
    """

    corner_m: Tuple[float, float]
    side_m: float
    stand: Stand


@dataclass(frozen=True, eq=False)
class Plants:
    """All plants that were told apart, in columns.

    Attributes:
        place_m: N×2, file coordinates [m].
        row: N, index in the rows.
        along_m: N, of the row [m].
        area_m2: N, green [m²].
        height_m: N, of the highest tenth, above the ground [m]; NaN where not known.
        certainty: N, that it is one plant, and no less than one.
    """

    place_m: Floats
    row: Integers
    along_m: Floats
    area_m2: Floats
    height_m: Floats
    certainty: Floats


@dataclass(frozen=True, eq=False)
class Gaps:
    """All gaps in rows, in columns.

    Attributes:
        place_m: N×2, the middles, file coordinates [m].
        row: N, index in the rows.
        from_m, to_m: N, along the row [m].
    """

    place_m: Floats
    row: Integers
    from_m: Floats
    to_m: Floats


@dataclass(frozen=True, eq=False)
class Weeds:
    """Green that reaches no row, in columns.

    Attributes:
        place_m: N×2, file coordinates [m].
        area_m2: N [m²].
    """

    place_m: Floats
    area_m2: Floats


@dataclass(frozen=True, eq=False)
class CropFacts:
    """What stands on a field.

    Attributes:
        countable: plants could be told apart somewhere.
        row_spacing_m: 0: there are no rows [m].
        row_heading_deg: counter-clockwise from x [degrees].
        plant_spacing_m: 0: plants cannot be counted [m].
        total: of all of it.
        rows, plants, gaps, weeds: each of them.
        squares: that the map shows something of.
        plots: those given, by name.
    """

    countable: bool
    row_spacing_m: float
    row_heading_deg: float
    plant_spacing_m: float
    total: Stand
    rows: Tuple[Row, ...]
    plants: Plants
    gaps: Gaps
    weeds: Weeds
    squares: Tuple[Square, ...]
    plots: Dict[str, Stand]


def facts_options() -> List[OptionInfo]:
    """The options of `facts`."""
    return infos_of(_core.facts_options())


def facts(
    source: Union[FieldMap, CloudLike],
    options: Optional[Mapping[str, Any]] = None,
    plots: Optional[Mapping[str, npt.ArrayLike]] = None,
    *,
    threads: int = 0,
    stop: Optional[Stop] = None,
) -> CropFacts:
    """Counts and measures what stands on a field: rows, plants, gaps, weeds, heights.

    Args:
        source: a cloud as for `register`, seen in cells as fine as its points; or a map that `fuse`
            returned, or the folder of one, seen in its cells and, where strips are, in theirs:
            ``agricolmap facts`` counts the same.
        options: by name, nested or with dots; `facts_options` lists them.
        plots: polygons by name, N×2 corners in file coordinates [m], to count in, too.
        threads, stop: as for `register`.

    Raises:
        InputError: when plants do not stand out from soil, or no plot lies on the map.
        UsageError: for options and plots that make no sense.
        Interrupted: when `stop` is set.
    """
    handle: Any
    folder = _arrays.is_path(source) and os.path.isdir(cast(PathLike, source))
    if folder or isinstance(source, FieldMap):
        handle = map_handle(source, "source")
    else:
        handle = cloud_of(source, "source")._handle
    named = corners(plots)
    values = _core.facts(
        handle, flat_texts(options or {}), named, stop, _arrays.count(threads, "threads")
    )
    return CropFacts(
        countable=values["countable"],
        row_spacing_m=values["row_spacing_m"],
        row_heading_deg=values["row_heading_deg"],
        plant_spacing_m=values["plant_spacing_m"],
        total=Stand(**values["total"]),
        rows=tuple(Row(line, Stand(**stand)) for line, stand in values["rows"]),
        plants=Plants(**values["plants"]),
        gaps=Gaps(**values["gaps"]),
        weeds=Weeds(**values["weeds"]),
        squares=tuple(
            Square(corner, side, Stand(**stand)) for corner, side, stand in values["squares"]
        ),
        plots={name: Stand(**plot) for (name, _), plot in zip(named, values["plots"])},
    )
