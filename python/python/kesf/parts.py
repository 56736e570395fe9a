"""Results in parts: a Parquet file for each shard of a large batch, whole or not at all, and all of them as one.

A folder of parts::

    out/part-0001-of-0007.parquet             results: one row group, units in the metadata of the fields
    out/_findings/part-0001-of-0007.parquet   what a reader must know
    out/_failures/part-0001-of-0007.parquet   what gave nothing

The metadata of a part has the version of kesf and a key, the hash of everything that the part depends on: a part with
the same key is not made again. The results are written last, so that a part that is there is complete. polars and
duckdb read ``out/part-*.parquet`` as one table. Needs pyarrow and fsspec.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import re
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _kesf
from ._errors import KesfError
from ._evaluate import Evaluation

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
    """The number of the shard, from 1, that a fabric belongs to: by the hash of the last part of its path without
    ending, whatever its case, so that fabrics that could be of one name are in one shard and are told apart there.

    >>> shard_of("lot1/Poplin.csv", 7) == shard_of("lot2/poplin", 7)
    True
    """
    stem = os.path.splitext(os.path.basename(path.rstrip("/")))[0].lower()
    return int.from_bytes(hashlib.sha256(stem.encode()).digest()[:8], "big") % count + 1


def key_of(*texts: str | bytes) -> str:
    """The hash of everything that a part depends on, and of the version of kesf."""
    digest = hashlib.sha256(_kesf.version().encode())
    for text in texts:
        data = text.encode() if isinstance(text, str) else text
        digest.update(len(data).to_bytes(8, "big") + data)
    return digest.hexdigest()


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
    system, place = filesystem(path if "://" in path else os.path.abspath(path), options)
    try:
        _write_whole(system, place, data)
    except OSError as error:
        raise KesfError(
            f"the file cannot be written: {error}",
            code="O001",
            path=path,
            cure="make room or correct the place, and run again: finished parts are kept",
        ) from error


def write(evaluation: Evaluation, out: str, shard: Shard, key: str, options: dict[str, Any] | None = None) -> None:
    """Writes the three files of a part, each whole or not at all, the results last.

    Raises:
        KesfError: O001 if a file cannot be written; what was half written is removed.
    """
    for name, folder in TABLES.items():
        data = parquet(getattr(evaluation, name), {"kesf.key": key, "kesf.shard": f"{shard.number}/{shard.count}"})
        write_file(f"{out.rstrip('/')}/{folder}{shard.file}", data, options)


def parquet(table: Any, metadata: dict[str, str]) -> bytes:
    """A table as Parquet, in one row group: the same table gives the same bytes."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        raise _needs("pyarrow") from error
    taken = pyarrow.table(table)
    told = {"kesf.version": _kesf.version(), **metadata}
    taken = taken.replace_schema_metadata({**(taken.schema.metadata or {}), **told})
    sink = io.BytesIO()
    pyarrow.parquet.write_table(taken, sink, compression="zstd", row_group_size=max(1, len(taken)))
    return sink.getvalue()


def _write_whole(system: Any, path: str, data: bytes) -> None:
    # An object of a store is there when all of it is; a file of a disk is, once it has its name.
    if system.protocol not in ("file", "local", ("file", "local")):
        system.pipe_file(path, data)
        return
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
    import pyarrow.parquet

    system, root = filesystem(out, options)
    path = f"{root}/{shard.file}"
    try:
        with system.open(path, "rb") as file:
            metadata = pyarrow.parquet.ParquetFile(file).schema_arrow.metadata or {}
    except (FileNotFoundError, pyarrow.ArrowInvalid):
        return None
    key = metadata.get(b"kesf.key")
    return None if key is None else key.decode()


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
    """The parts as one table of pyarrow, in order of the fabrics' names: the same for any number of shards.

    Args:
        out: The folder of parts, a path or URL.
        table: ``results``, ``findings`` or ``failures``.
        options: Options of the file system.

    Raises:
        KesfError: O059 if parts are missing or of different runs, O042 if one cannot be read, and O056 if a fabric is
            in two of them.
    """
    import pyarrow
    import pyarrow.compute
    import pyarrow.parquet

    if table not in TABLES:
        raise KesfError(f"`{table}` is no table of a part", cure="take results, findings or failures")
    shards = complete(out, options)
    system, root = filesystem(out, options)
    taken: list[pyarrow.Table] = []
    seen: dict[str, Shard] = {}
    for shard in shards:
        path = f"{root}/{TABLES[table]}{shard.file}"
        try:
            with system.open(path, "rb") as file:
                part = pyarrow.parquet.read_table(file)
        except (FileNotFoundError, pyarrow.ArrowInvalid, OSError) as error:
            raise KesfError(
                f"the part cannot be read: {error}",
                code="O042",
                path=path,
                cure="remove it and run again: the other parts are kept",
            ) from error
        if table == "results":
            _distinct(part, shard, seen, path)
        taken.append(part.replace_schema_metadata({"kesf.version": _kesf.version()}))
    whole = pyarrow.concat_tables(taken)
    order = pyarrow.compute.sort_indices(
        whole.append_column("row", pyarrow.array(range(len(whole)))),
        sort_keys=[("fabric", "ascending"), ("row", "ascending")]
        if table == "results"
        else [("fabric", "ascending"), ("place", "ascending"), ("code", "ascending"), ("message", "ascending")],
    )
    return whole.take(order).combine_chunks()


def _distinct(part: pyarrow.Table, shard: Shard, seen: dict[str, Shard], path: str) -> None:
    for fabric in part.column("fabric").unique().to_pylist():
        if fabric in seen:
            raise KesfError(
                f"{fabric} is in {seen[fabric].file} and in {shard.file}",
                code="O056",
                path=path,
                cure="give the fabrics folders or sample names of their own, or make one shard of them",
            )
        seen[fabric] = shard


def complete(out: str, options: dict[str, Any] | None = None) -> Sequence[Shard]:
    """The parts, if all are there and of one run."""
    shards = listed(out, options)
    if not shards:
        raise KesfError("there is no part", code="O059", path=out, cure="name a folder that kesf.dask.run wrote")
    counts = {shard.count for shard in shards}
    if len(counts) > 1:
        raise KesfError(
            f"there are parts of runs with {' and '.join(map(str, sorted(counts)))} shards",
            code="O059",
            path=out,
            cure="remove those of one run, or write each run to a folder of its own",
        )
    (count,) = counts
    missing = sorted(set(range(1, count + 1)) - {shard.number for shard in shards})
    if missing:
        raise KesfError(
            f"{len(missing)} of {count} parts are missing, number {missing[0]} first",
            code="O059",
            path=out,
            cure="run again: finished parts are kept",
        )
    return shards
