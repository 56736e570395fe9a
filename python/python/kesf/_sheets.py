"""Sheets: the parameters of fabrics."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, get_args, overload

import numpy as np

from . import _kesf
from ._calls import unit_system
from ._errors import Failure, Finding, KesfError, findings_of
from ._fabrics import named
from ._html import findings as html_findings
from ._html import lines, number
from ._html import table as html_table
from ._table import Table
from ._types import Direction, Test, Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Estimate:
    """A value over the repeats.

    Attributes:
        mean: Mean, in ``unit``.
        sd: Sample standard deviation; None for a single value.
        n: Number of repeats.
        unit: SI unit.
        cv: Coefficient of variation, SD / |mean|.
        ci95: Half width of the 95 % Student t interval of the mean.
        status: ``measured``, ``inferred``, ``assumed`` or ``doubtful``: a finding speaks of it.
    """

    mean: float | None
    sd: float | None
    n: int
    unit: str
    cv: float | None = None
    ci95: float | None = None
    status: str | None = None

    def __str__(self) -> str:
        spread = f" ± {number(self.sd)}" if self.sd is not None else ""
        return f"{number(self.mean)}{spread} {self.unit}"


class Sheet:
    """The parameters of a fabric; made by :func:`kesf.characterise`. Values are SI.

    It pickles as what it was made of, and is made again to the last digit; a pickle is for the version of kesf that
    wrote it.

    >>> import kesf
    >>> sheet = kesf.characterise("kesf_data/poplin")
    >>> sheet["B", "warp"].unit, sheet["B", "warp"].n
    ('N·m', 3)
    >>> sheet["T0"].unit
    'm'
    """

    def __init__(self, native: _kesf.Sheet) -> None:
        self._native = native

    @classmethod
    def from_json(cls, text: str | bytes) -> Sheet:
        """The sheet of a document ``kesf.sheet/1`` with one fabric: its values and friction laws, without curves and
        findings."""
        sheets = Sheets.from_json(text)
        if len(sheets) != 1:
            raise KesfError(f"the document has {len(sheets)} fabrics", cure="take kesf.Sheets.from_json(text)")
        return sheets[0]

    def to_json(self) -> str:
        """The document ``kesf.sheet/1``, as ``kesf characterise -o sheet.json`` writes it."""
        return self._native.document()

    @cached_property
    def _document(self) -> dict[str, Any]:
        document: dict[str, Any] = json.loads(self._native.document())
        return document

    @property
    def _entry(self) -> dict[str, Any]:
        entry: dict[str, Any] = self._document["fabrics"][0]
        return entry

    @property
    def name(self) -> str:
        """Identifier of the fabric."""
        return str(self._entry["name"])

    @property
    def title(self) -> str:
        """Name for people."""
        return str(self._entry["title"])

    @property
    def origin(self) -> str:
        """``measured``, ``published`` or ``synthetic``."""
        return str(self._entry["origin"])

    @property
    def path(self) -> str:
        """The folder or file; empty for a sheet of a document."""
        return os.fspath(self._native.path)

    @cached_property
    def info(self) -> dict[str, Any]:
        """What ``fabric.toml`` says of the fabric, with measured behaviour to compare predictions with."""
        info: dict[str, Any] = json.loads(self._native.info())
        return info

    @cached_property
    def values(self) -> dict[str, dict[str | None, Estimate]]:
        """Every parameter by symbol and direction; the direction None is the fabric as a whole."""
        values: dict[str, dict[str | None, Estimate]] = {}
        for symbol, entry in self._entry["parameters"].items():
            if "mean" in entry:
                values[symbol] = {None: Estimate(**entry)}
            else:
                values[symbol] = {_direction(d): Estimate(**e) for d, e in entry.items()}
        return values

    @cached_property
    def moduli(self) -> dict[str, dict[str | None, Estimate]]:
        """Tensile moduli (N/m) by name (``tangent_low``, ``secant``, ``energy``) and direction."""
        moduli = self._entry["moduli"].items()
        return {name: {_direction(d): Estimate(**e) for d, e in by.items()} for name, by in moduli}

    @property
    def friction(self) -> list[dict[str, Any]]:
        """Friction laws (SI): test, direction, specimen, basis, backbone, sliders and how well each fits."""
        friction: list[dict[str, Any]] = self._entry["friction"]
        return friction

    @property
    def settings(self) -> dict[str, str]:
        """Windows and readings behind the values, in words."""
        settings: dict[str, str] = self._document["settings"]
        return settings

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What a reader of the sheet must know."""
        return findings_of(self._native.findings())

    def get(self, parameter: str, direction: Direction | None = None) -> Estimate | None:
        """A parameter in a direction, or of the fabric as a whole; None if it is not known.

        >>> import kesf
        >>> sheet = kesf.characterise("kesf_data/poplin")
        >>> sheet.get("B", "bias") is None
        True
        """
        return self.values.get(parameter, {}).get(direction)

    def __getitem__(self, key: str | tuple[str, Direction | None]) -> Estimate:
        """``sheet["B", "warp"]`` or ``sheet["T0"]``."""
        parameter, direction = (key, None) if isinstance(key, str) else key
        found = self.get(parameter, direction)
        if found is None:
            known = [" ".join(filter(None, (p, d))) for p, by in self.values.items() for d in by]
            raise KeyError(f"{self.name} has no {parameter} {direction or ''}; it has {', '.join(known)}")
        return found

    def parameters(self, units: Units = "si", wide: bool = False) -> Table:
        """Parameters and moduli as a table; see :meth:`Sheets.parameters`."""
        return Sheets([self]).parameters(units, wide)

    def plot(self, test: Test = "bending", axes: Axes | None = None) -> Figure:
        """A figure of a test from the data of its PNG chart: loops of all specimens, their mean, and where the
        parameters are read. Needs matplotlib."""
        from .plot import plot

        return plot(self, test, axes)

    def curves(self, test: Test) -> dict[str, Any]:
        """What the chart of a test shows, in SI: ``specimens``, each with ``direction``, ``specimen``, ``branches``
        (corrected runs with ``curve`` x and y), ``windows`` (readings) and ``values``; ``mean``, the mean branches over
        two specimens or more with their 95 % bands; ``units`` and ``factors``, the KES units of both axes and their SI
        values."""
        curves: dict[str, Any] = json.loads(self._native.curves(test))
        return curves

    def chart(self, test: Test) -> bytes:
        """The PNG chart of a test, as ``kesf run`` writes it."""
        return self._native.chart(test)

    def __eq__(self, other: object) -> bool:
        return self._native == other._native if isinstance(other, Sheet) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return _sheet, (_kesf.version(), self._native.packed())

    def __repr__(self) -> str:
        count = sum(len(by) for by in self.values.values())
        return f"<kesf.Sheet {self.name}: {count} values, {self.origin} data, {len(self.findings)} findings>"

    def _repr_html_(self) -> str:
        rows = [
            (symbol, direction or "", e.mean, e.sd, e.n, e.unit, e.status)
            for symbol, by in self.values.items()
            for direction, e in by.items()
        ]
        header = ("parameter", "direction", "mean", "SD", "n", "unit", "status")
        caption = f"{self.title or self.name}, {self.origin} data"
        return html_table(header, rows, caption, 60) + self._sparklines() + html_findings(self.findings)

    def _sparklines(self) -> str:
        """A small picture of each test that has curves: all runs of all specimens."""
        pictures = []
        for test in get_args(Test):
            drawn = [
                (np.array(branch["curve"]["x"]), np.array(branch["curve"]["y"]))
                for specimen in self.curves(test)["specimens"]
                for branch in specimen["branches"]
            ]
            if drawn:
                pictures.append(f"<td>{test}<br>{lines(drawn, 140)}</td>")
        return f"<table><tr>{''.join(pictures)}</tr></table>" if pictures else ""


def _direction(name: str) -> str | None:
    return None if name == "fabric" else name


def _sheet(version: str, packed: bytes) -> Sheet:
    return Sheet(_kesf.Sheet.unpacked(version, packed))


class Sheets(Sequence[Sheet]):
    """The sheets of several fabrics, each with a name of its own.

    Attributes:
        failures: What could not be read of the batch that they are of.

    >>> import kesf
    >>> sheets = kesf.characterise(kesf.read("kesf_data"))
    >>> len(sheets), sheets["petrak_m1"].origin
    (13, 'published')
    """

    def __init__(self, sheets: Sequence[Sheet], failures: tuple[Failure, ...] = ()) -> None:
        self._sheets = tuple(sheets)
        self.failures = failures

    @classmethod
    def from_json(cls, text: str | bytes) -> Sheets:
        """The sheets of a document ``kesf.sheet/1``: their values and friction laws, without curves and findings."""
        text = text.decode() if isinstance(text, bytes) else text
        return cls([Sheet(native) for native in _kesf.Sheet.of_document(text)])

    def parameters(self, units: Units = "si", wide: bool = False) -> Table:
        """Parameters and moduli of all fabrics as a table.

        A row each: fabric, parameter (``E secant`` is a modulus), direction, mean, sd, n, unit, status, cv, ci95,
        origin. With ``wide`` a row a fabric, and a column for each parameter in a direction (``B_warp``, ``T0``,
        ``E_secant_weft``) with its unit in the metadata; behind each is its status in a column of its own
        (``B_warp_status``: measured, inferred, assumed or doubtful), and the origin comes last.

        >>> import kesf
        >>> wide = kesf.characterise("kesf_data/petrak_m1").parameters(wide=True)
        >>> wide.units["B_warp"], wide["B_warp_status"][0], len(wide)
        ('N·m', 'measured', 1)
        """
        native = [sheet._native for sheet in self._sheets]
        table = _kesf.Sheet.wide if wide else _kesf.Sheet.parameters
        return Table(table(native, unit_system(units)))

    @overload
    def __getitem__(self, index: int | str) -> Sheet: ...
    @overload
    def __getitem__(self, index: slice) -> Sheets: ...
    def __getitem__(self, index: int | str | slice) -> Sheet | Sheets:
        """A sheet by its place or the name of its fabric, or some of them."""
        if isinstance(index, slice):
            return Sheets(self._sheets[index], self.failures)
        if isinstance(index, str):
            return named(self._sheets, index)
        return self._sheets[index]

    def __len__(self) -> int:
        return len(self._sheets)

    def __iter__(self) -> Iterator[Sheet]:
        return iter(self._sheets)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sheets):
            return NotImplemented
        return (self._sheets, self.failures) == (other._sheets, other.failures)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        failed = f", {len(self.failures)} failures" if self.failures else ""
        return f"<kesf.Sheets: {len(self)} fabrics{failed}>"

    def _repr_html_(self) -> str:
        table = self.parameters("kes", wide=True)
        shown = [
            n
            for n in table.column_names
            if n in ("fabric", "B_warp", "B_weft", "G_warp", "G_weft", "G", "W", "T0", "origin")
        ]
        columns = table.to_pydict()
        units = table.units
        header = [f"{name} ({units[name]})" if name in units else name for name in shown]

        def cell(name: str, row: int) -> str:
            status = columns.get(f"{name}_status", ["measured"] * len(table))[row]
            return number(columns[name][row]) + (f" ({status})" if status not in (None, "measured") else "")

        return html_table(header, [[cell(name, row) for name in shown] for row in range(len(table))])
