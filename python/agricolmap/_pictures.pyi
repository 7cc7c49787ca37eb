import os
from typing import List, Optional, Union

from ._core import Cloud, Registration

def write_pictures(
    folder: Union[str, "os.PathLike[str]"], registration: Registration, /
) -> List[str]: ...
def write_page(
    folder: Union[str, "os.PathLike[str]"],
    registration: Registration,
    pictures: List[str],
    fixed: Optional[Cloud],
    moving: Optional[Cloud],
    /,
) -> None: ...
