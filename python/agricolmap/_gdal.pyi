from typing import Tuple

from ._core import Cloud

def read_pair(
    fixed: str, fixed_crs: str, moving: str, moving_crs: str, /
) -> Tuple[Cloud, Cloud]: ...
def read_map(path: str, crs: str, target: str, /) -> Cloud: ...
