import os
from typing import List, Union

from ._core import Registration

def write_pictures(
    folder: Union[str, "os.PathLike[str]"], registration: Registration, /
) -> List[str]: ...
