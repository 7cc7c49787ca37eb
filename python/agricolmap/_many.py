"""Many strips in one go, each to a folder."""

from __future__ import annotations

import datetime
import json
import os
from dataclasses import dataclass
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Tuple, Union

import numpy as np

from . import _arrays
from ._arrays import Floats, PathLike
from ._errors import UsageError
from ._register import Stop
from ._result import Status


@dataclass(frozen=True, eq=False)
class BatchEntry:
    """What became of a strip.

    Attributes:
        id: its name, which is that of its folder.
        map: the id of its map.
        folder: with its results; of one that failed those of an earlier run, or not there.
        status: None: it failed, and `message` says why.
        plane_probability: that it is right in the plane to 5 cm.
        expected_rms_m: in the plane [m]; None where there is no answer.
        heights_measured: else they are limited.
        height_deviation_m: expected, of the heights [m]; None where there is none.
        seconds: that it took.
        date: YYYYMMDD; 0: nobody said.
        message: why it is not accepted, in a line.
        kept: was there already.
        outline_m: N×2, corners around the strip from above, fixed file's coordinates [m].
    """

    id: str
    map: str
    folder: str
    status: Optional[Status]
    plane_probability: float
    expected_rms_m: Optional[float]
    heights_measured: bool
    height_deviation_m: Optional[float]
    seconds: float
    date: int
    message: str
    kept: bool
    outline_m: Floats

    @property
    def accepted(self) -> bool:
        """Whether the status is accepted."""
        return self.status is Status.ACCEPTED

    @property
    def failed(self) -> bool:
        """Whether there is no answer."""
        return self.status is None


def batch(
    manifest: Union[PathLike, Mapping[str, Any]],
    output: PathLike,
    *,
    resume: bool = False,
    overwrite: bool = False,
    items: Optional[Iterable[Union[str, int]]] = None,
    shard: Optional[Tuple[int, int]] = None,
    jobs: int = 0,
    memory: float = 0.0,
    pictures: bool = True,
    progress: Optional[Callable[[BatchEntry, int, int], Any]] = None,
    threads: int = 0,
    stop: Optional[Stop] = None,
) -> List[BatchEntry]:
    """Registers the strips of a manifest, each to a folder, as ``agricolmap batch`` does.

    A folder ``output/ID`` appears whole or not at all, whenever the program ends. A strip that fails
    leaves what an earlier run made of it, and stops no other. Of all strips, ``summary.csv``,
    ``.json``, ``.html`` and ``.png`` are written into `output`.

    Args:
        manifest: the path of a YAML file (``docs/batch.md``), or what would stand in it:
            ``{"maps": [{"id": "field", "file": "drone.laz"}], "strips": [{"file": "drives/*.ply"}]}``,
            whose files are relative to the current folder.
        output: folder of the results.
        resume: keep folders whose files and options are those of the manifest now.
        overwrite: do all again, and replace what is there. Without one of both, results that are
            there are an `OutputError`.
        items: these strips alone, by their ids or numbers from 1.
        shard: (i, n): every n-th strip alone, from the i-th on, counted from 1. Parts write no
            summary.
        jobs: strips at once, at most; 0: as many as threads.
        memory: that all strips at once may take [bytes]; 0: four fifths of what is available.
        pictures: False: none, whatever the manifest says.
        progress: called with each entry that is done, how many are, and of how many, from this
            thread. What it raises stops the batch and is raised.
        threads, stop: as for `register`. What was done by then stays, and `resume` does the rest.

    Returns:
        The entries that were chosen, in the manifest's order.

    Raises:
        UsageError: with all that is wrong in the manifest, and for arguments that make no sense.
        InputError: for a manifest that cannot be read.
        OutputError: when results are there already, or cannot be written.
        Interrupted: when `stop` is set.
    """
    from . import _batch

    name, text = _manifest(manifest)
    chosen = _items(items)
    part = (0, 0)
    if shard is not None:
        given: Tuple[Any, ...] = tuple(shard) if isinstance(shard, Iterable) else ()
        numbers = tuple(_arrays.count(number, "shard") for number in given)
        if len(numbers) != 2 or not 1 <= numbers[0] <= numbers[1]:
            raise UsageError(f"shard: is {shard!r}; give (i, n), i from 1 to n")
        part = numbers[0], numbers[1]
    if progress is not None and not callable(progress):
        raise UsageError("progress: cannot be called; give a function of an entry and two numbers")

    def tell(values: Dict[str, Any], done: int, todo: int) -> None:
        if progress is not None:
            progress(_entry(values), done, todo)

    found = _batch.register_all(
        name,
        _arrays.path_of(output, "output"),
        text,
        (bool(resume), bool(overwrite)),
        chosen,
        part,
        (_arrays.count(jobs, "jobs"), _arrays.number(memory, "memory", "bytes"), bool(pictures)),
        None if progress is None else tell,
        stop,
        _arrays.count(threads, "threads"),
    )
    return [_entry(values) for values in found]


def _entry(values: Dict[str, Any]) -> BatchEntry:
    status = values.pop("status")
    folder = os.fspath(values.pop("folder"))
    return BatchEntry(**values, folder=folder, status=None if status is None else Status(status))


def _items(items: Any) -> List[str]:
    """None of them: all strips."""
    if items is None:
        return []
    if isinstance(items, (str, bytes)) or not isinstance(items, Iterable):
        raise UsageError("items: give a list of ids or numbers")
    chosen = [str(item) for item in items]
    if not chosen:
        raise UsageError("items: is empty; give those to register, or None for all")
    return chosen


def _manifest(value: Any) -> Tuple[str, Optional[str]]:
    """Its file, or what it is called and what stands in it."""
    if _arrays.is_path(value):
        return os.fspath(value), None
    if not isinstance(value, Mapping):
        kind = type(value).__name__
        raise UsageError(f"manifest: is a {kind}; give the path of a file, or a dict of its fields")

    def plain(item: Any) -> Any:
        if isinstance(item, datetime.date):
            return item.isoformat()
        if isinstance(item, os.PathLike):
            return os.fspath(item)
        if isinstance(item, Mapping):
            return dict(item)
        if isinstance(item, np.generic):
            return item.item()
        raise UsageError(f"manifest: has a {type(item).__name__}; give texts, numbers and dates")

    try:
        # As it stands: what JSON escapes beyond 16 bits is no YAML.
        return "manifest", json.dumps(dict(value), default=plain, ensure_ascii=False)
    except UsageError:
        raise
    except (TypeError, ValueError) as error:
        raise UsageError(f"manifest: {error}; give texts, numbers and dates") from None
