"""Lays a ground robot's 3D map of a crop field into a drone's.

    result = agricolmap.register("drone.laz", "robot.ply")
    print(result)
    if result.accepted:
        result.aligned("robot.ply").write("aligned.ply")

Clouds are files or NumPy arrays; see `register`, `Cloud` and `read`. Metres; degrees only in names
that end in ``_deg``. Transformations are 4×4, ``fixed = transform @ moving``.
"""

from . import _core
from ._arrays import PathLike
from ._change import BeforeAfter, Change, ChangedSquare, PartChange, Share, diff
from ._cloud import Cloud, CloudLike, Crs, read
from ._errors import Error, InputError, Interrupted, OutputError, UsageError
from ._facts import (
    CropFacts,
    Gaps,
    Plants,
    Row,
    Square,
    Stand,
    Weeds,
    facts,
    facts_options,
)
from ._field import FieldMap, FineCells, FusedStrip, Strip, fuse, fuse_options
from ._many import BatchEntry, batch
from ._maps import CellMap, map_cloud
from ._options import OptionInfo, Options, Prior
from ._register import Stop, register
from ._result import (
    Alternative,
    Deformation,
    Evidence,
    Heights,
    Node,
    Parts,
    Registration,
    Slip,
    Status,
    Uncertainty,
)
from ._stages import Pair, Place
from ._transforms import read_matrix, read_path, write_matrix

__version__ = _core.version()

__all__ = [
    "Alternative",
    "BatchEntry",
    "BeforeAfter",
    "CellMap",
    "Change",
    "ChangedSquare",
    "Cloud",
    "CloudLike",
    "CropFacts",
    "Crs",
    "Deformation",
    "Error",
    "Evidence",
    "FieldMap",
    "FineCells",
    "FusedStrip",
    "Gaps",
    "Heights",
    "InputError",
    "Interrupted",
    "Node",
    "OptionInfo",
    "Options",
    "OutputError",
    "Pair",
    "PartChange",
    "Parts",
    "PathLike",
    "Place",
    "Plants",
    "Prior",
    "Registration",
    "Row",
    "Share",
    "Slip",
    "Square",
    "Stand",
    "Status",
    "Stop",
    "Strip",
    "Uncertainty",
    "UsageError",
    "Weeds",
    "__version__",
    "aligned",
    "batch",
    "diff",
    "facts",
    "facts_options",
    "fuse",
    "fuse_options",
    "map_cloud",
    "read",
    "read_matrix",
    "read_path",
    "register",
    "write_matrix",
]


def aligned(cloud: CloudLike, result: Registration) -> Cloud:
    """The moving cloud where a registration lays it: ``result.aligned(cloud)``."""
    return result.aligned(cloud)
