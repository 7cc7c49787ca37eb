from typing import Any, Callable, Dict, List, Optional, Tuple, Union
import os

_Path = Union[str, "os.PathLike[str]"]

def register_all(
    manifest: _Path,
    output: _Path,
    text: Optional[str],
    existing: Tuple[bool, bool],
    items: List[str],
    part: Tuple[int, int],
    limits: Tuple[int, float, bool],
    progress: Optional[Callable[[Dict[str, Any], int, int], Any]],
    stop: Optional[Any],
    threads: int,
    /,
) -> List[Dict[str, Any]]: ...
