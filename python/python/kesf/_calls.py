"""What several functions do with their arguments."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any, cast

from . import _kesf
from ._errors import KesfError
from ._types import Bar, CaseLike, Path, Progress, SettingsLike, Units

#: What stands for a file of bytes.
BYTES = "<bytes>"


def follower(progress: Progress | None) -> Callable[[str, int, int], object] | None:
    """A function to be called with what is done, how many steps are done, and how many there are."""
    if progress is None or not hasattr(progress, "update"):
        return progress
    bar = cast("Bar", progress)
    shown = 0

    def follow(what: str, done: int, of: int) -> None:
        nonlocal shown
        if done < shown:
            shown = 0
        if bar.total != of:
            bar.total = of
        describe = getattr(bar, "set_description", None)
        if done == 0 and describe is not None:
            describe(what)
        bar.update(done - shown)
        shown = done

    return follow


def unit_system(units: Units) -> str:
    """The units, or an error for others."""
    if units not in ("si", "kes"):
        raise KesfError(f"`{units}` is no system of units", cure='take "si" or "kes"')
    return units


def sources(inputs: object) -> tuple[list[str], list[tuple[str, bytes]]]:
    """Paths, and files in memory with what stands for their names."""
    paths: list[str] = []
    memory: list[tuple[str, bytes]] = []
    several = not isinstance(inputs, (str, bytes, bytearray, memoryview, os.PathLike, Mapping))
    # A frame of polars or pandas would be taken for the names of its columns.
    if several and (hasattr(inputs, "columns") or not isinstance(inputs, Iterable)):
        raise _nothing_to_read(inputs)
    # A pair of a name and bytes is one file, and no two.
    if isinstance(inputs, tuple) and len(inputs) == 2 and isinstance(inputs[1], (bytes, bytearray, memoryview)):
        several = not isinstance(inputs[0], (str, os.PathLike))
    for item in cast("Iterable[object]", inputs) if several else [inputs]:
        if isinstance(item, (str, os.PathLike)):
            paths.append(os.fspath(cast("Path", item)))
        elif isinstance(item, (bytes, bytearray, memoryview)):
            memory.append((BYTES if not memory else f"<bytes {len(memory) + 1}>", bytes(item)))
        elif isinstance(item, tuple) and len(item) == 2 and isinstance(item[1], (bytes, bytearray, memoryview)):
            memory.append((str(item[0]), bytes(item[1])))
        else:
            raise _nothing_to_read(item)
    return paths, memory


def _nothing_to_read(item: object) -> KesfError:
    cure = "give a path, bytes, a pair of a name and bytes, or several of these"
    if hasattr(item, "columns"):
        cure = "kesf.evaluate takes tables of curves; kesf.read takes files"
    return KesfError(f"{type(item).__name__} is nothing to read", cure=cure)


def json_of(data: object) -> str:
    """JSON, in which numbers and arrays of numpy are those of Python."""

    def plain(value: object) -> object:
        as_list = getattr(value, "tolist", None)
        if as_list is None:
            raise TypeError(f"{type(value).__name__} is no value of a table")
        return as_list()

    return json.dumps(data, default=plain, allow_nan=False)


def toml(data: Mapping[str, Any], what: str) -> str:
    """Nested mappings as TOML."""
    try:
        return _kesf.case_text(json_of(data))
    except (TypeError, ValueError) as error:
        raise KesfError(f"{what} cannot be written as TOML: {error}") from error


def text_of(given: SettingsLike | CaseLike, name: str, what: str) -> tuple[str, str]:
    """Name and text of a TOML file, whether it is on disk, in memory, or nested mappings."""
    if isinstance(given, Mapping):
        return name, toml(given, what)
    path = name if isinstance(given, bytes) else os.fspath(given)
    try:
        if isinstance(given, bytes):
            return path, given.decode()
        with open(path, encoding="utf-8") as file:
            return path, file.read()
    except (OSError, UnicodeDecodeError) as error:
        raise KesfError(f"{what} cannot be read: {error}", code="R001", path=path) from error


def case_of(case: CaseLike) -> tuple[str, str | None]:
    """Name of a case, and its text if it is not to be read from a file of that name."""
    if isinstance(case, (bytes, Mapping)):
        return text_of(case, "<case>", "the case")
    if not isinstance(case, (str, os.PathLike)):
        raise KesfError(
            f"{type(case).__name__} is no case", cure="give a case file, the bytes of one, or its tables as mappings"
        )
    path = os.fspath(case)
    if "\n" in path:
        raise KesfError(
            "a case file is expected, and this is a text", cure="give text.encode(), or its tables as a dict"
        )
    return path, None
