"""Names of types that stand in several places."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.uint32]

#: A file or folder.
Path = str | os.PathLike[str]

#: A case: a file, the bytes of one, or its tables as nested mappings.
CaseLike = str | os.PathLike[str] | bytes | Mapping[str, Any]

#: Settings of the evaluation: a TOML file, the bytes of one, or its keys and values.
SettingsLike = str | os.PathLike[str] | bytes | Mapping[str, Any]

#: Units of tables: SI, or those that are customary for KES.
Units = Literal["si", "kes"]

#: A KES test.
Test = Literal["tensile", "shear", "bending", "compression", "friction", "roughness"]

#: A yarn direction.
Direction = Literal["warp", "weft", "bias"]


class Bar(Protocol):
    """A progress bar such as ``tqdm.tqdm()``."""

    total: Any

    def update(self, n: int = 1) -> Any: ...


#: Who follows long work: a progress bar such as ``tqdm.tqdm()``, or a function that is called with what is done, how
#: many steps are done and how many there are.
Progress = Bar | Callable[[str, int, int], object]
