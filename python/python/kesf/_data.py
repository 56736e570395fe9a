"""What results have in common: plain data, so that everything pickles and compares."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: A field of a native call: name, type, shape and bytes.
RawArray = tuple[str, str, Sequence[int], bytes]


def arrays_of(raw: Sequence[RawArray]) -> dict[str, NDArray[Any]]:
    """Read-only arrays of their bytes."""
    return {name: np.frombuffer(data, dtype=kind).reshape(shape) for name, kind, shape, data in raw}


def _same(a: object, b: object) -> bool:
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return a.shape == b.shape and np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
    if isinstance(a, dict) and isinstance(b, dict):
        return list(a) == list(b) and all(_same(a[key], b[key]) for key in a)
    return bool(a == b)


class Result:
    """Equality of all fields, arrays included."""

    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(_same(getattr(self, name), getattr(other, name)) for name in self.__dict__)


#: What a native simulation gives: document, predictions, history, arrays, findings, failures.
RawOutcome = tuple[str, Any, Any, Sequence[RawArray], str, str]
