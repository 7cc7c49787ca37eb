"""Files beside a report."""

from __future__ import annotations

import contextlib
import os
from typing import Iterable

#: What a registration may be drawn as.
PICTURES = [f"overlay_{when}.png" for when in ("before", "after")]
PICTURES += [f"{name}.png" for name in ("exg_maps", "flow", "blocks", "deformation")]


def remove(folder: str, names: Iterable[str]) -> None:
    """Those that are there."""
    for name in names:
        with contextlib.suppress(FileNotFoundError):
            os.remove(os.path.join(folder, name))
