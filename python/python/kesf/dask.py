"""Libraries of fabrics on a cluster, with dask.distributed: a part a shard, and nothing done twice."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from . import _kesf, parts
from ._calls import follower, sources
from ._errors import KesfError
from ._evaluate import Evaluation, evaluation_of, find
from ._functions import Readable, _options
from ._table import Table
from ._types import Path, Progress

#: What the tasks of shards are called, in the dashboard and in logs; number, number of shards and hash follow.
TASK = "kesf-shard"

#: Fabrics of a shard, where no number of shards is given: some seconds of work.
PER_SHARD = 1000


@dataclass(frozen=True)
class Task:
    """What a worker needs to make a part: it is sent to it, and nothing else is.

    Attributes:
        fabrics: Folders and files, paths or URLs.
        cases: Names and texts of the cases.
        settings: Text of the settings file, if any.
        out: The folder of parts, a path or URL.
        shard: Which part.
        key: Hash of everything that the part depends on.
        set_up: Hash of what all parts of the batch share.
        drape: Whether drape cases are solved too.
        options: Options of the file systems.
    """

    fabrics: tuple[str, ...]
    cases: tuple[tuple[str, bytes], ...]
    settings: bytes | None
    out: str
    shard: parts.Shard
    key: str
    set_up: str
    drape: bool
    options: dict[str, Any]

    @property
    def name(self) -> str:
        """What the task is called: ``kesf-shard-3-of-7-`` and its key. Dask shows tasks of one kind as one bar."""
        return f"{TASK}-{self.shard.number}-of-{self.shard.count}-{self.key}"


@dataclass(frozen=True)
class Done:
    """What became of a shard.

    Attributes:
        shard: Which.
        fabrics: Number of fabrics that it was given.
        rows: Rows of results; None of a part that was there already.
        failures: What gave nothing; None of a part that was there already.
        kept: Whether the part was there already, with the same key.
    """

    shard: parts.Shard
    fabrics: int
    rows: int | None
    failures: int | None
    kept: bool


def run(
    inputs: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    cases: Readable | Iterable[Readable] = (),
    out: Path = "results",
    client: Any = None,
    *,
    shards: int | None = None,
    settings: Path | None = None,
    drape: bool = False,
    retries: int = 3,
    storage_options: dict[str, Any] | None = None,
    progress: Progress | None = None,
) -> list[Done]:
    """Evaluates a library of fabrics on a cluster: every fabric and every case, a Parquet part a shard.

    Args:
        inputs: Folders and files, paths or URLs of fsspec (``s3://``, ``gs://``, ``zip://::fabrics.zip``). Workers must
            be able to open them.
        cases: Case files, or pairs of a name and bytes; they are sent to the workers.
        out: The folder of parts, a path or URL; see :mod:`kesf.parts`.
        client: A client of dask.distributed; a local cluster when None.
        shards: Number of parts; one for each thousand fabrics, and at least one, when None. The merged tables do not
            depend on it.
        settings: TOML file with windows and thresholds of the evaluation; it is sent to the workers.
        drape: Whether drape cases are solved too.
        retries: How often a shard is tried again whose worker failed.
        storage_options: Options of the file systems, such as ``endpoint_url``.
        progress: A bar such as ``tqdm.tqdm()``, or a function of what is done (``"shards"``), shards done and shards in
            all: called here and not on the workers. The dashboard shows the same as one bar, ``kesf-shard``.

    Returns:
        What became of each shard, in order. A part that is there with the same key is kept.

    Raises:
        KesfError: if there is nothing to do, parts of another number of shards are there, or shards failed for good;
            the parts of the others are there, and another run makes those that are missing.
    """
    tasks = plan(inputs, cases, out, shards, settings, drape, storage_options)
    try:
        from distributed import Client, as_completed
    except ImportError as error:
        raise KesfError(
            "dask.distributed is not installed", code="O053", cure='pip install "dask[distributed]"'
        ) from error
    own = client is None
    client = Client() if own else client
    follow = follower(progress) or (lambda what, done, of: None)
    done: list[Done] = []
    failed: list[tuple[Task, BaseException]] = []
    futures: dict[Any, Task] = {}
    try:
        futures = {client.submit(work, task, key=task.name, retries=retries): task for task in tasks}
        follow("shards", 0, len(tasks))
        # None is released before all are done: a bar of the dashboard would lose what is finished. What a worker keeps
        # of a shard are these few numbers.
        for future in as_completed(list(futures)):
            reason = future.exception()
            if reason is None:
                done.append(future.result())
            else:
                failed.append((futures[future], reason))
            follow("shards", len(done) + len(failed), len(tasks))
    finally:
        # Where the caller gave up, what has not begun never does.
        client.cancel([future for future in futures if not future.done()])
        for future in futures:
            future.release()
        if own:
            client.close()
    if failed:
        raise _failure(failed, len(tasks))
    return sorted(done, key=lambda one: one.shard.number)


def _failure(failed: Sequence[tuple[Task, BaseException]], count: int) -> KesfError:
    task, error = failed[0]
    first = f"number {task.shard.number} first: {error}"
    return KesfError(
        f"{len(failed)} of {count} shards failed, {first}",
        code=error.code if isinstance(error, KesfError) else "O053",
        path=task.out,
        cure="run again: finished parts are kept",
    )


def plan(
    inputs: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    cases: Readable | Iterable[Readable] = (),
    out: Path = "results",
    shards: int | None = None,
    settings: Path | None = None,
    drape: bool = False,
    storage_options: dict[str, Any] | None = None,
) -> list[Task]:
    """The tasks of :func:`run`, for other engines: ``kesf.dask.work(task)`` does one, on any machine.

    A shard that has no fabric has a task too, so that the parts say that nothing is missing.
    """
    options = storage_options or {}
    given = [inputs] if isinstance(inputs, (str, os.PathLike)) else list(inputs)
    stamps = fabrics([_absolute(os.fspath(one)) for one in given], options)
    if not stamps:
        raise KesfError("there is no measurement in the inputs", code="O055", cure="name folders of fabrics")
    count = shards or max(1, -(-len(stamps) // PER_SHARD))
    place = _absolute(os.fspath(out))
    others = {shard.count for shard in parts.listed(place, options)} - {count}
    if others:
        raise KesfError(
            f"there are parts of a run with {' and '.join(map(str, sorted(others)))} shards, and this one has {count}",
            code="O066",
            path=place,
            cure="give that number of shards, remove those parts, or name another folder",
        )
    texts = _cases(cases)
    how = _read(settings) if settings is not None else None
    divided: list[list[str]] = [[] for _ in range(count)]
    for path in sorted(stamps):
        divided[parts.shard_of(path, count) - 1].append(path)
    of_cases = [part for name, text in texts for part in (name, text)]
    set_up = parts.key_of(f"{count} {drape}", how or b"", *of_cases, *[_absolute(os.fspath(one)) for one in given])
    tasks = []
    for number, mine in enumerate(divided, 1):
        told = [f"{path}\n{stamps[path]}" for path in mine]
        key = parts.key_of(f"{number}/{count} {drape}", how or b"", *of_cases, *told)
        shard = parts.Shard(number, count)
        tasks.append(Task(tuple(mine), texts, how, place, shard, key, set_up, drape, options))
    return tasks


def _absolute(path: str) -> str:
    """A path that is the same for workers, which have working folders of their own."""
    return path if "://" in path or "::" in path else os.path.abspath(path)


def _cases(cases: Readable | Iterable[Readable]) -> tuple[tuple[str, bytes], ...]:
    paths, memory = sources(cases)
    files: list[tuple[str, bytes]] = []
    for path in paths:
        if os.path.isdir(path):
            raise KesfError("a folder of cases is not sent to workers", path=path, cure="name the case files")
        files.append((path, _read(path)))
    return tuple(files + memory)


def _read(path: Path) -> bytes:
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise KesfError(f"the file cannot be read: {error}", code="R001", path=os.fspath(path)) from error


def fabrics(inputs: Sequence[str], options: dict[str, Any] | None = None) -> dict[str, str]:
    """The folder or file of each fabric below paths and URLs, with a hash that changes with it: of the sizes and
    times of its files, or of what a store tells of its objects."""
    found: dict[str, str] = {}
    for url in inputs:
        if "://" in url or "::" in url:
            found.update(_remote(url, options or {}))
            continue
        if not os.path.exists(url):
            raise KesfError("there is no such file or folder", code="R001", path=url)
        by_path = find(url)
        for path, files in by_path.items():
            # A folder with fabrics in folders below it is given by its own files.
            inside = any(other != path and other.startswith(path.rstrip("/") + "/") for other in by_path)
            for own in files if inside else [path]:
                found[own] = _stamp(own)
    return found


def _stamp(path: str) -> str:
    """A hash that changes with a file, or with anything in a folder."""
    folders = os.walk(path) if os.path.isdir(path) else [("", [], [path])]
    files = sorted(os.path.join(folder, name) for folder, _, names in folders for name in names)
    told = [(file, os.stat(file)) for file in files]
    return parts.key_of(*(f"{file} {stat.st_size} {stat.st_mtime_ns}" for file, stat in told))


def _remote(url: str, options: dict[str, Any]) -> dict[str, str]:
    system, root = parts.filesystem(url, options)
    try:
        files = system.find(root, detail=True)
    except (OSError, ValueError) as error:
        raise KesfError(f"the place cannot be read: {error}", code="R001", path=url) from error
    if not files:
        raise KesfError("there is no such file or folder", code="R001", path=url)
    chain = url.split("::", 1)[1] if "::" in url else None
    found: dict[str, list[str]] = {}
    for path in sorted(files):
        folder = path.rsplit("/", 1)[0] if "/" in path and path != root else path
        found.setdefault(_url(system, folder, chain), []).append(f"{path} {system.ukey(path)}")
    return {name: parts.key_of(*told) for name, told in found.items()}


def _url(system: Any, path: str, chain: str | None) -> str:
    if chain is None:
        return str(system.unstrip_protocol(path))
    protocol = system.protocol if isinstance(system.protocol, str) else system.protocol[0]
    return f"{protocol}://{path}::{chain}"


def work(task: Task, threads: int | None = None) -> Done:
    """Makes the part of a task, unless it is there: on a worker of dask with its threads, or anywhere, with all threads
    of the machine unless their number is given."""
    count = len(task.fabrics)
    if parts.key_in(task.out, task.shard, task.options) == task.key:
        return Done(task.shard, count, None, None, kept=True)
    with tempfile.TemporaryDirectory(prefix="kesf-") as scratch:
        evaluation = _evaluate(task, scratch, threads or _threads())
    parts.write(evaluation, task.out, task.shard, task.key, task.options, task.set_up)
    return Done(task.shard, count, len(evaluation), len(evaluation.failures), kept=False)


def _evaluate(task: Task, scratch: str, threads: int | None) -> Evaluation:
    settings = None
    if task.settings is not None:
        settings = os.path.join(scratch, "settings.toml")
        with open(settings, "wb") as file:
            file.write(task.settings)
    paths, names = _fetched(task, scratch)
    # A shard may have no fabric, and what is true of all fabrics is told by one of them.
    making = (settings, task.drape, (task.shard.number, task.shard.count, False))
    memory = [(os.fspath(name), text) for name, text in task.cases]
    evaluation = evaluation_of(
        _kesf.evaluate((paths, memory, None), _options(None, None, None, False), making, threads)
    )
    if not names:
        return evaluation
    findings, failures = (_renamed(table, names) for table in (evaluation.findings, evaluation.failures))
    return replace(evaluation, findings=findings, failures=failures)


def _fetched(task: Task, scratch: str) -> tuple[list[str], dict[str, str]]:
    """Local paths of the fabrics, and the URLs that local folders stand for."""
    paths: list[str] = []
    names: dict[str, str] = {}
    for number, url in enumerate(task.fabrics):
        if "://" not in url and "::" not in url:
            if not os.path.exists(url):
                raise KesfError("there is no such file or folder on this worker", code="R001", path=url)
            paths.append(url)
            continue
        system, path = parts.filesystem(url, task.options)
        name = os.path.basename(path.rstrip("/"))
        place = os.path.join(scratch, f"{number:06d}", name)
        os.makedirs(os.path.dirname(place), exist_ok=True)
        try:
            if system.isdir(path):
                for file in system.ls(path, detail=False):
                    if not system.isdir(file):
                        target = os.path.join(place, os.path.basename(file))
                        system.get_file(file, target) if os.path.isdir(place) else _first(system, file, target)
            else:
                system.get_file(path, place)
        except (OSError, ValueError) as error:
            raise KesfError(f"the file cannot be fetched: {error}", code="R001", path=url) from error
        paths.append(place)
        names[place] = url
    return paths, names


def _first(system: Any, file: str, target: str) -> None:
    os.makedirs(os.path.dirname(target), exist_ok=True)
    system.get_file(file, target)


def _renamed(table: Table, names: dict[str, str]) -> Table:
    columns = table.to_pydict()
    for column in ("place", "message"):
        for place, url in names.items():
            columns[column] = [text.replace(place, url) for text in columns[column]]
    cells: list[tuple[str, str, dict[str, str], list[Any]]] = [
        (name, "text", {}, list(column)) for name, column in columns.items()
    ]
    return Table(_kesf.Table._from_columns(cells))


def _threads() -> int | None:
    """Threads of this worker of dask; None elsewhere."""
    try:
        from distributed import get_worker

        return int(get_worker().state.nthreads)
    except (ImportError, ValueError):
        return None
