"""The unit of work of a cluster: some fabrics in, one table out, and nothing else."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, cast

from . import _kesf
from ._calls import follower, sources
from ._data import Result
from ._errors import KesfError
from ._functions import Readable, _options
from ._table import Table
from ._types import Path, Progress

#: Columns of a table of curves, as :meth:`kesf.Batch.curves` gives it.
CURVES = ("fabric", "test", "direction", "specimen", "index", "x", "x_unit", "y", "y_unit", "origin")


@dataclass(frozen=True, eq=False)
class Evaluation(Result):
    """Everything that is known of some fabrics, as one table (SI); made by :func:`kesf.evaluate`.

    It is a table for programs of data frames itself, as ``results`` is. Columns: fabric, case (null for a measured
    parameter), quantity (``B`` with its direction, ``E secant``, or what a case predicts, such as ``w_max``),
    direction, value, unit, sd and n of a parameter, the measured value beside a prediction, low and high, its
    95 % band, the status of a parameter as in ``fabrics.csv`` (``doubtful`` is one that a finding speaks of) or of a
    prediction as in ``predictions.csv``, the origin of the fabric, and a remark on a prediction.

    Attributes:
        results: Parameters and predictions.
        findings: What a reader of the results must know: fabric, code, place, message, hint.
        failures: What gave nothing, likewise.
    """

    results: Table
    findings: Table = field(repr=False)
    failures: Table = field(repr=False)
    # For a part of a batch: what its fabrics are to the cases (JSON), and whether another run could find more.
    _cases: str = field(default="[]", repr=False)
    _unfinished: bool = field(default=False, repr=False)

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
        batch: Folders and files of fabrics as in :func:`kesf.read`; or an Arrow table (needs pyarrow) of files, with a
            column ``path`` and, for files that are not on disk, ``content``; or of curves, a row a point, as
            ``batch.curves()`` and ``kesf read -o curves.parquet`` give it: their tests are taken for standard ones.
        cases: Case files, bytes, or pairs of a name and bytes.
        settings: TOML file with windows and thresholds of the evaluation.
        drape: Whether drape cases are solved too.
        dialect, delimiter, decimal, assume_kes_units, threads, progress: As in :func:`kesf.read`.

    Returns:
        The results. What fails is in ``failures`` and costs the others nothing.

    Raises:
        KesfError: if the settings cannot be used, or there is nothing to do; O073 for a table that is not understood.

    >>> import kesf
    >>> done = kesf.evaluate(["kesf_data/petrak_m1"], "cases/virtual_bending.toml")
    >>> [row["quantity"] for row in done.results.rows() if row["case"]]
    ['B warp', 'B weft']
    """
    given, curves = _given(batch)
    paths, memory = sources(given)
    case_paths, case_memory = sources(cases)
    making = (None if settings is None else os.fspath(settings), drape, None)
    options = _options(dialect, delimiter, decimal, assume_kes_units)
    whole = (paths + case_paths, memory + case_memory, curves)
    return evaluation_of(_kesf.evaluate(whole, options, making, threads, follower(progress)))


def evaluation_of(raw: tuple[Any, Any, Any, str, bool]) -> Evaluation:
    """The evaluation of its native tables."""
    results, findings, failures, cases, unfinished = raw
    return Evaluation(Table(results), Table(findings), Table(failures), cases, unfinished)


def _given(batch: object) -> tuple[Iterable[Any], Any]:
    """Files, and the columns of a table of curves, if it is one."""
    if not hasattr(batch, "__arrow_c_stream__"):
        return cast("Iterable[Any]", batch), None
    try:
        import pyarrow
    except ImportError as error:
        raise KesfError(
            "a table is read with pyarrow, which is not installed",
            code="O053",
            cure="pip install pyarrow, or give a list of paths",
        ) from error
    table = pyarrow.table(batch)
    if "path" in table.column_names:
        names = table.column("path").to_pylist()
        contents = table.column("content").to_pylist() if "content" in table.column_names else [None] * len(names)
        return [n if data is None else (n, data) for n, data in zip(names, contents, strict=True)], None
    # A table of an earlier version does not say where its curves come from.
    unsaid = ("direction", "origin")
    missing = [name for name in CURVES if name not in table.column_names and name != "origin"]
    if missing:
        raise KesfError(
            f"the table has no column `path` and no column `{missing[0]}`; it has {', '.join(table.column_names)}",
            code="O073",
            cure=f"a table of files has `path` (and `content`), one of curves has {', '.join(CURVES)}",
        )
    columns = [
        table.column(name).to_pylist() if name in table.column_names else [None] * table.num_rows for name in CURVES
    ]
    for name, column in zip(CURVES, columns, strict=True):
        if name not in unsaid and None in column:
            raise KesfError(
                f"row {column.index(None) + 1} of the table of curves has no {name}",
                code="O073",
                cure="every point has all cells but the direction, which compression has not",
            )
    return [], tuple(columns)


def find(
    inputs: Readable | Iterable[Readable],
    *,
    dialect: Path | None = None,
    delimiter: str | None = None,
    decimal: str | None = None,
    assume_kes_units: bool = False,
) -> dict[str, list[str]]:
    """The folder or file of each fabric below the inputs, with its measurement files: what can be divided among several
    machines. Nothing is read; a file may turn out to hold several fabrics. A folder that cannot be opened, or whose
    ``fabric.toml`` or ``dialect.toml`` cannot be read, has that in the place of its files: evaluating it tells why.

    >>> import kesf
    >>> len(kesf.find("kesf_data")["kesf_data/poplin"])
    21
    """
    paths, memory = sources(inputs)
    if memory:
        raise KesfError("files in memory cannot be looked for", cure="give paths")
    found = _kesf.find(paths, _options(dialect, delimiter, decimal, assume_kes_units))
    return {os.fspath(path): [os.fspath(file) for file in files] for path, files in found}
