"""The unit of work of a cluster: some fabrics in, one table out, and nothing else."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

from . import _kesf
from ._calls import follower, sources
from ._data import Result
from ._errors import KesfError
from ._functions import Readable, _Making, _options
from ._reports import Run, run_of
from ._table import Table
from ._types import Path, Progress

#: Columns of the results, with their kinds.
RESULTS = {
    "fabric": "text",
    "case": "text",
    "quantity": "text",
    "direction": "text",
    "value": "number",
    "unit": "text",
    "sd": "number",
    "n": "count",
    "measured": "number",
    "low": "number",
    "high": "number",
    "status": "text",
}

#: Columns of findings and failures.
PROBLEMS = {"fabric": "text", "code": "text", "place": "text", "message": "text"}


@dataclass(frozen=True, eq=False)
class Evaluation(Result):
    """Everything that is known of some fabrics, as one table (SI); made by :func:`kesf.evaluate`.

    It is a table for programs of data frames itself, as ``results`` is. Columns: fabric, case (null for a measured
    parameter), quantity (``B`` with its direction, ``E secant``, or what a case predicts, such as ``w_max``),
    direction, value, unit, sd and n of a parameter, the measured value beside a prediction, low and high, its
    95 % band, and the status of a parameter as in ``fabrics.csv``: ``doubtful`` is one that a finding speaks of.

    Attributes:
        results: Parameters and predictions.
        findings: What a reader of the results must know: fabric, code, place, message.
        failures: What gave nothing, likewise.
    """

    results: Table
    findings: Table = field(repr=False)
    failures: Table = field(repr=False)

    def __arrow_c_schema__(self) -> object:
        """The schema of the results, as a capsule."""
        return self.results.__arrow_c_schema__()

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """The results, as a capsule."""
        return self.results.__arrow_c_stream__(requested_schema)

    def __len__(self) -> int:
        return len(self.results)

    def _repr_html_(self) -> str:
        return self.results._repr_html_()


def evaluate(
    batch: object,
    cases: Readable | Iterable[Readable] = (),
    settings: Path | None = None,
    *,
    drape: bool = False,
    dialect: Path | None = None,
    delimiter: str | None = None,
    decimal: str | None = None,
    assume_kes_units: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Evaluation:
    """Characterises fabrics and solves cases for each of them: a pure function, for workers of a cluster.

    Args:
        batch: Folders and files of fabrics as in :func:`kesf.read`; or an Arrow table of files, with a column ``path``
            and, for files that are not on disk, ``content`` (needs pyarrow).
        cases: Case files, bytes, or pairs of a name and bytes.
        settings: TOML file with windows and thresholds of the evaluation.
        drape: Whether drape cases are solved too.
        dialect, delimiter, decimal, assume_kes_units, threads, progress: As in :func:`kesf.read`.

    Returns:
        The results. What fails is in ``failures`` and costs the others nothing.

    Raises:
        KesfError: if the settings cannot be used, or there is nothing to do.

    >>> import kesf
    >>> done = kesf.evaluate(["kesf_data/petrak_m1"], "cases/virtual_bending.toml")
    >>> [row["quantity"] for row in done.results.rows() if row["case"]]
    ['B warp', 'B weft']
    """
    paths, memory = sources(_files(batch))
    case_paths, case_memory = sources(cases)
    making = _Making(
        out=None,
        keep=False,
        charts=False,
        drape=drape,
        stamp=None,
        force=False,
        solver=None,
        settings=None if settings is None else os.fspath(settings),
    )
    options = _options(dialect, delimiter, decimal, assume_kes_units)
    raw = _kesf.run(paths + case_paths, memory + case_memory, options, making, threads, follower(progress))
    parameters, predictions, problems, _, told, fails_a_check = raw
    return evaluation_of(run_of((parameters, predictions, problems, told, fails_a_check), {}))


def _files(batch: object) -> Iterable[Any]:
    if not hasattr(batch, "__arrow_c_stream__"):
        return cast("Iterable[Any]", batch)
    try:
        import pyarrow
    except ImportError as error:
        raise KesfError(
            "a table of files is read with pyarrow, which is not installed",
            code="O053",
            cure="pip install pyarrow, or give a list of paths",
        ) from error
    table = pyarrow.table(batch)
    if "path" not in table.column_names:
        raise KesfError(
            f"the table of files has no column `path`; it has {', '.join(table.column_names)}",
            cure="name the column of files `path`, and the column of their bytes, if any, `content`",
        )
    names = table.column("path").to_pylist()
    contents = table.column("content").to_pylist() if "content" in table.column_names else [None] * len(names)
    return [name if data is None else (name, data) for name, data in zip(names, contents, strict=True)]


def evaluation_of(run: Run) -> Evaluation:
    """The tables of a run as one."""
    # A row without a value stands for a fabric that failed: it is among the failures.
    rows = [_parameter(row) for row in run.parameters.rows() if row["mean"] is not None]
    rows += [_prediction(row) for row in run.predictions.rows()]
    problems = run.problems.rows()
    # The failures come first; a table of problems has no other mark of them.
    count = len(run.failures)
    return Evaluation(
        results=table_of(RESULTS, rows),
        findings=table_of(PROBLEMS, problems[count:]),
        failures=table_of(PROBLEMS, problems[:count]),
    )


def _parameter(row: dict[str, Any]) -> dict[str, Any]:
    return {
        "fabric": row["fabric"],
        "quantity": row["parameter"],
        "direction": row["direction"],
        "value": row["mean"],
        "unit": row["unit"],
        "sd": row["sd"],
        "n": row["n"],
        "status": row["status"],
    }


def _prediction(row: dict[str, Any]) -> dict[str, Any]:
    return {
        "fabric": row["fabric"],
        "case": row["case"],
        "quantity": row["quantity"],
        "value": row["simulated"],
        "unit": row["unit"],
        "measured": row["measured"],
        "low": row["simulated_low"],
        "high": row["simulated_high"],
    }


def table_of(columns: dict[str, str], rows: Sequence[dict[str, Any]]) -> Table:
    """A table of rows; a cell that a row does not have is null."""
    units = {"unit_column": "unit"}
    numbers = [name for name, kind in columns.items() if kind == "number"]
    cells = [
        (name, kind, units if name in numbers else {}, [row.get(name) for row in rows])
        for name, kind in columns.items()
    ]
    return Table(_kesf.Table._from_columns(cells))


def find(
    inputs: Readable | Iterable[Readable],
    *,
    dialect: Path | None = None,
    delimiter: str | None = None,
    decimal: str | None = None,
    assume_kes_units: bool = False,
) -> dict[str, list[str]]:
    """The folder or file of each fabric below the inputs, with its measurement files: what can be divided among several
    machines. Nothing is read; a file may turn out to hold several fabrics.

    >>> import kesf
    >>> len(kesf.find("kesf_data")["kesf_data/poplin"])
    21
    """
    paths, memory = sources(inputs)
    if memory:
        raise KesfError("files in memory cannot be looked for", cure="give paths")
    found = _kesf.find(paths, _options(dialect, delimiter, decimal, assume_kes_units))
    return {os.fspath(path): [os.fspath(file) for file in files] for path, files in found}
