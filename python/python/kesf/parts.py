"""Results in parts: a Parquet file for each shard of a large batch, whole or not at all, and all of them as one.

A folder of parts::

    out/part-0001-of-0007.parquet             results: one row group, units in the metadata of the fields
    out/_findings/part-0001-of-0007.parquet   what a reader must know
    out/_failures/part-0001-of-0007.parquet   what gave nothing

The metadata of a part has the version of kesf and a key, the hash of everything that the part depends on: a part with
the same key is not made again. The results are written last, so that a part that is there is complete. The command's
``kesf run --shard`` and ``kesf merge`` write and read the same files; polars and duckdb read ``out/part-*.parquet`` as
one table. Needs fsspec, and pyarrow for tables; a file on the disk is written without either.
"""

from __future__ import annotations

import contextlib
import os
import re
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _kesf
from ._errors import KesfError
from ._evaluate import Evaluation
from ._table import Table

if TYPE_CHECKING:
    import pyarrow

#: Tables of a part and where they are; the results come last.
TABLES = {"findings": "_findings/", "failures": "_failures/", "results": ""}

_NAME = re.compile(r"part-(\d+)-of-(\d+)\.parquet$")


@dataclass(frozen=True)
class Shard:
    """A part of a batch.

    Attributes:
        number: Which, from 1.
        count: Of how many.
    """

    number: int
    count: int

    def __post_init__(self) -> None:
        if not 1 <= self.number <= self.count:
            raise KesfError(f"there is no shard {self.number} of {self.count}", cure="shards count from 1")

    @property
    def file(self) -> str:
        """Name of its files."""
        return f"part-{self.number:04d}-of-{self.count:04d}.parquet"


def shard_of(path: str, count: int) -> int:
    """The number of the shard, from 1, that a fabric belongs to: by the hash of the name that it gets in results of its
    folder, or of its file without ending, so that fabrics that could be of one name are in one shard and are told apart
    there.

    >>> shard_of("lot1/Poplin.csv", 7) == shard_of("zip://lot2/poplin::fabrics.zip", 7)
    True
    """
    # Of a chained URL, such as zip://lot1/poplin::fabrics.zip, the fabric is the first link.
    return _kesf.shard_of(path.split("::", 1)[0].rstrip("/"), count)


def key_of(*texts: str | bytes) -> str:
    """The hash of everything that a part depends on, and of the version of kesf."""
    return _kesf.key_of([text.encode() if isinstance(text, str) else text for text in texts])


def _needs(module: str) -> KesfError:
    return KesfError(f"{module} is not installed", code="O053", cure=f"pip install {module}")


def filesystem(url: str, options: dict[str, Any] | None = None) -> tuple[Any, str]:
    """The fsspec file system of a path or URL, and the path there."""
    try:
        import fsspec
    except ImportError as error:
        raise _needs("fsspec") from error
    try:
        system, path = fsspec.core.url_to_fs(url, **(options or {}))
    except (ValueError, ImportError, OSError) as error:
        raise KesfError(f"the place cannot be opened: {error}", code="R001", path=url) from error
    return system, path


def write_file(path: str, data: bytes, options: dict[str, Any] | None = None) -> None:
    """Writes a file, a path or URL, whole or not at all.

    Raises:
        KesfError: O001 if it cannot be written; what was half written is removed.
    """
    # The disk needs no fsspec, which a bare environment does not have.
    system, place = filesystem(path, options) if "://" in path else (None, os.path.abspath(path))
    try:
        # An object of a store is there when all of it is; a file of a disk is, once it has its name.
        if system is None or system.protocol in ("file", "local", ("file", "local")):
            _write_whole(place, data)
        else:
            system.pipe_file(place, data)
    except OSError as error:
        raise KesfError(
            f"the file cannot be written: {error}",
            code="O001",
            path=path,
            cure="make room or correct the place, and run again: finished parts are kept",
        ) from error


def write(
    evaluation: Evaluation, out: str, shard: Shard, key: str, options: dict[str, Any] | None = None, set_up: str = ""
) -> None:
    """Writes the three files of a part, each whole or not at all, the results last.

    Args:
        evaluation: What is known of its fabrics.
        out: The folder of parts, a path or URL.
        shard: Which part.
        key: Hash of everything that it depends on.
        options: Options of the file system.
        set_up: Hash of what all parts of the batch share; :func:`merge` refuses parts that differ in it.

    Raises:
        KesfError: O001 if a file cannot be written; what was half written is removed.
    """
    tables = (evaluation.findings._native, evaluation.failures._native, evaluation.results._native)
    files = _kesf.part_files(
        tables, evaluation._cases, (shard.number, shard.count), set_up, "" if evaluation._unfinished else key
    )
    for name, data in files:
        write_file(f"{out.rstrip('/')}/{name}", data, options)


def _write_whole(path: str, data: bytes) -> None:
    folder = os.path.dirname(path)
    os.makedirs(folder, exist_ok=True)
    name = os.path.basename(path)
    half = os.path.join(folder, f".{name}.{uuid.uuid4().hex}.half")
    try:
        with open(half, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.replace(half, path)
    finally:
        # This one if it failed, and what a worker left that was killed while it wrote the same part.
        for left in os.listdir(folder):
            if left.startswith(f".{name}.") and left.endswith(".half"):
                with contextlib.suppress(FileNotFoundError):
                    os.remove(os.path.join(folder, left))


def key_in(out: str, shard: Shard, options: dict[str, Any] | None = None) -> str | None:
    """The key of a part that is there; None if there is none, or if it cannot be read."""
    system, root = filesystem(out, options)
    try:
        with system.open(f"{root}/{shard.file}", "rb") as file:
            return _kesf.key_in(file.read())
    except FileNotFoundError:
        return None


def listed(out: str, options: dict[str, Any] | None = None) -> list[Shard]:
    """The parts that are there, in order."""
    system, root = filesystem(out, options)
    try:
        names = [str(name) for name in system.ls(root, detail=False)]
    except FileNotFoundError:
        return []
    found = (_NAME.search(name) for name in names)
    return sorted((Shard(int(m[1]), int(m[2])) for m in found if m), key=lambda s: (s.count, s.number))


def merge(out: str, table: str = "results", options: dict[str, Any] | None = None) -> pyarrow.Table:
    """The parts as one table of pyarrow, in order of the fabrics' names: the same for any number of shards. Findings
    and failures that only the whole batch tells are added: fabrics without a law that a case needs, and cases that
    found no fabric.

    Args:
        out: The folder of parts, a path or URL.
        table: ``results``, ``findings`` or ``failures``.
        options: Options of the file system.

    Raises:
        KesfError: O065 if parts are missing, O066 if they are of different runs, O067 if one cannot be read, and O068
            if a fabric is in two of them.
    """
    try:
        import pyarrow
    except ImportError as error:
        raise _needs("pyarrow") from error
    return pyarrow.table(Table(_kesf.merge(out, _files(out, table, options), table)))


def merge_file(out: str, table: str = "results", options: dict[str, Any] | None = None) -> bytes:
    """The same as the bytes of a Parquet file, those of ``kesf merge -o``."""
    return _kesf.merge_file(out, _files(out, table, options), table)


def _files(out: str, table: str, options: dict[str, Any] | None) -> list[tuple[int, int, bytes, bytes, bytes]]:
    if table not in TABLES:
        raise KesfError(f"`{table}` is no table of a part", code="O050", cure="take results, findings or failures")
    system, root = filesystem(out, options)
    files = []
    for shard in complete(out, options):
        parts = []
        for folder in TABLES.values():
            try:
                with system.open(f"{root}/{folder}{shard.file}", "rb") as file:
                    parts.append(file.read())
            except (FileNotFoundError, OSError) as error:
                raise KesfError(
                    f"the part cannot be read: {error}",
                    code="O067",
                    path=f"{out.rstrip('/')}/{folder}{shard.file}",
                    cure="remove it and run again: the other parts are kept",
                ) from error
        files.append((shard.number, shard.count, *parts))
    return files


def complete(out: str, options: dict[str, Any] | None = None) -> Sequence[Shard]:
    """The parts, if all are there and of one run."""
    shards = listed(out, options)
    _kesf.complete(out, [(shard.number, shard.count) for shard in shards])
    return shards
