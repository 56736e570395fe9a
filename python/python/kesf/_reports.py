"""Comparisons, runs and the verification suite."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ._data import RawOutcome, Result
from ._errors import Failure, Finding, failures_of, findings_of
from ._html import findings as html_findings
from ._html import lines, number
from ._html import table as html_table
from ._table import Table, predictions_html
from ._types import Floats


@dataclass(frozen=True, eq=False)
class Curve(Result):
    """A simulated curve beside the measured one, in SI, at the abscissae of the corrected records.

    The branches of all specimens stand one behind the other; :meth:`Sheet.curves` has them apart.

    Attributes:
        name: Such as ``bending warp``.
        x: Abscissae, shape (n,), of each branch in the order of its record.
        simulated: Simulated ordinates, shape (n,).
        measured: Measured ordinates, shape (n,).
        unit: Unit of the ordinates.
        rmse: Root mean square difference, in ``unit``.
        nrmse: The same over the measured span (1).
        r2: Coefficient of determination.
    """

    name: str
    x: Floats
    simulated: Floats
    measured: Floats
    unit: str
    rmse: float | None
    nrmse: float | None
    r2: float | None


@dataclass(frozen=True, eq=False)
class Comparison(Result):
    """A simulated instrument test beside its measurement, in SI; made by :func:`kesf.compare`.

    Attributes:
        entries: Its entries of ``kesf.comparison/1``, one a direction.
        predictions: Its rows of ``predictions.csv``: each stiffness, simulated and measured.
        findings: What a reader of the result must know.
        failures: Directions that gave nothing.

    >>> import kesf
    >>> sheet = kesf.characterise("kesf_data/poplin")
    >>> comparison = kesf.compare("cases/virtual_bending.toml", sheet)
    >>> [curve.name for curve in comparison.curves]
    ['bending warp', 'bending weft']
    >>> abs(comparison.predictions["error"][0]) < 1e-3
    True
    """

    entries: list[dict[str, Any]] = field(repr=False)
    predictions: Table = field(repr=False)
    findings: tuple[Finding, ...] = field(repr=False)
    failures: tuple[Failure, ...] = field(repr=False)

    @property
    def case(self) -> str:
        """Name of the case."""
        return str(self.entries[0]["case"]) if self.entries else ""

    @property
    def fabric(self) -> str | None:
        """Name of the fabric."""
        fabric: str | None = self.entries[0]["fabric"] if self.entries else None
        return fabric

    @property
    def curves(self) -> list[Curve]:
        """Simulated and measured curves, one a direction; of fabrics with curves only."""
        return [
            Curve(
                name=entry["name"],
                x=np.array(entry["x"], dtype=np.float64),
                simulated=np.array(entry["simulated"], dtype=np.float64),
                measured=np.array(entry["measured"], dtype=np.float64),
                unit=entry["unit"],
                rmse=entry["rmse"],
                nrmse=entry["nrmse"],
                r2=entry["r2"],
            )
            for entry in self.entries
            if entry.get("x") is not None
        ]

    def __repr__(self) -> str:
        rows = self.predictions.rows()
        told = ", ".join(f"{r['quantity']} {number(r['simulated'])} {r['unit']}" for r in rows)
        return f"<kesf.Comparison {self.case} of {self.fabric}: {told}>"

    def _repr_html_(self) -> str:
        header = ("quantity", "simulated", "measured", "unit", "error")
        pictures = [lines([(c.x, c.measured), (c.x, c.simulated)], 160) for c in self.curves]
        told = predictions_html(self.predictions, f"{self.case}, {self.fabric}", header)
        return told + "".join(pictures) + html_findings(self.findings)


@dataclass(frozen=True, eq=False)
class Run(Result):
    """What a run gave; made by :func:`kesf.run`.

    Attributes:
        parameters: The rows of ``fabrics.csv`` (SI).
        predictions: The rows of ``predictions.csv`` (SI).
        problems: The rows of ``problems.csv``: failures and findings with their places.
        files: Every file by its name, of a run without a folder; else empty.
        findings: What a reader of the results must know.
        failures: What failed, of inputs and tasks; it cost the others nothing.
        notes: Remarks, such as cases that were left out.
        fails_a_check: Whether a check of a case does not hold.
    """

    parameters: Table
    predictions: Table
    problems: Table
    files: dict[str, bytes] = field(repr=False)
    findings: tuple[Finding, ...] = field(repr=False)
    failures: tuple[Failure, ...] = field(repr=False)
    notes: tuple[str, ...] = ()
    fails_a_check: bool = False

    @property
    def fabrics(self) -> list[str]:
        """Names of the fabrics, in order."""
        return list(dict.fromkeys(self.parameters["fabric"]))

    def __repr__(self) -> str:
        counts = f"{len(self.fabrics)} fabrics, {len(self.predictions)} predictions"
        return f"<kesf.Run: {counts}, {len(self.findings)} findings, {len(self.failures)} failures>"

    def _repr_html_(self) -> str:
        header = ("fabric", "case", "quantity", "simulated", "measured", "unit", "error")
        failed = html_table(("failed", "code", "why"), [(f.path, f.code, f.message) for f in self.failures])
        return predictions_html(self.predictions, "", header) + (failed if self.failures else "")


@dataclass(frozen=True, eq=False)
class Verification(Result):
    """Lines of the verification suite with what came out; made by :func:`kesf.verify`.

    Attributes:
        document: The document ``kesf.verify/1``.

    >>> import kesf
    >>> suite = kesf.verify("clamped")
    >>> suite.passed
    True
    """

    document: dict[str, Any] = field(repr=False)

    @property
    def lines(self) -> list[dict[str, Any]]:
        """The lines: id, quantity, value, reference, error, tolerance, kind, citation and whether each passes."""
        entries: list[dict[str, Any]] = self.document["lines"]
        return entries

    @property
    def passed(self) -> bool:
        """Whether every line holds."""
        return all(line["pass"] for line in self.lines)

    def __len__(self) -> int:
        return len(self.lines)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self.lines)

    def __repr__(self) -> str:
        return f"<kesf.Verification: {sum(line['pass'] for line in self.lines)} of {len(self)} lines hold>"

    def _repr_html_(self) -> str:
        header = ("id", "value", "reference", "error", "pass")
        rows = [[line.get(name) for name in header] for line in self.lines]
        return html_table(header, rows, repr(self)[1:-1], 40)


def comparison_of(raw: RawOutcome) -> Comparison:
    """The comparison of a native simulation."""
    document, predictions, _, _, findings, failures = raw
    return Comparison(
        entries=json.loads(document)["comparisons"],
        predictions=Table(predictions),
        findings=findings_of(findings),
        failures=failures_of(failures),
    )


def run_of(raw: tuple[Any, ...], files: Mapping[str, bytes]) -> Run:
    """The report of a native run."""
    parameters, predictions, problems, (findings, failures, notes), fails_a_check = raw
    return Run(
        parameters=Table(parameters),
        predictions=Table(predictions),
        problems=Table(problems),
        files=dict(files),
        findings=findings_of(findings),
        failures=failures_of(failures),
        notes=tuple(json.loads(notes)),
        fails_a_check=fails_a_check,
    )
