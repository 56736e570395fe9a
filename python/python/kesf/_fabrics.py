"""Fabrics: what was measured."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from typing import Any, Protocol, TypeVar, get_args, overload

import numpy as np

from . import _kesf
from ._calls import unit_system
from ._errors import Failure, Finding, KesfError, findings_of
from ._html import lines
from ._html import table as html_table
from ._table import Table
from ._types import Direction, Floats, Test, Units

Named = TypeVar("Named", bound="HasName")


class HasName(Protocol):
    """What has a name."""

    @property
    def name(self) -> str:
        """The name."""


def _floats(raw: bytes) -> Floats:
    return np.frombuffer(raw, dtype="=f8")


@dataclass(frozen=True, eq=False)
class Measurement:
    """The curve of one specimen in one test, as recorded, in SI.

    Attributes:
        test: ``tensile``, ``shear``, ``bending``, ``compression``, ``friction`` or ``roughness``.
        direction: ``warp``, ``weft`` or ``bias``; None for compression.
        specimen: Number of the specimen, from 1.
        sample: Name of the sample in the file, if any.
        x: Abscissae, shape (n,): strain (1), shear angle (rad), curvature (1/m), thickness (m) or
            position (m).
        y: Ordinates, shape (n,): force per width (N/m), the same, moment per width (N), pressure (Pa),
            coefficient of friction (1) or height (m).
        x_unit: Unit of ``x``.
        y_unit: Unit of ``y``.
        conditions: ``width`` and ``gauge`` (m); ``maximum`` of what is driven: tensile (N/m), shear (rad), bending
            (1/m), compression (Pa), friction and roughness (m); ``pretension`` (N/m); with FB4 ``contact`` (N).
        path: The file.
        metadata: Everything else that the header said.
    """

    test: Test
    direction: Direction | None
    specimen: int
    sample: str | None
    x: Floats = field(repr=False)
    y: Floats = field(repr=False)
    x_unit: str
    y_unit: str
    conditions: dict[str, float | None] = field(repr=False)
    path: str
    metadata: dict[str, str] = field(repr=False)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Measurement):
            return NotImplemented
        rest = [k for k in self.__dataclass_fields__ if k not in ("x", "y")]
        same = all(getattr(self, name) == getattr(other, name) for name in rest)
        return same and np.array_equal(self.x, other.x) and np.array_equal(self.y, other.y)

    __hash__ = None  # type: ignore[assignment]

    def __len__(self) -> int:
        """Number of points."""
        return len(self.x)

    def _repr_html_(self) -> str:
        what = " ".join(str(part) for part in (self.test, self.direction, self.specimen) if part)
        told = f"{len(self)} points, {self.y_unit} over {self.x_unit}"
        return f"<div><b>{escape(what)}</b>: {escape(told)}<br>{lines([(self.x, self.y)])}</div>"


class Fabric:
    """Everything that was read of one fabric; made by :func:`kesf.read`.

    It pickles with all that was read, to the last digit; a pickle is for the version of kesf that wrote it.

    >>> import kesf
    >>> fabric = kesf.read("kesf_data/poplin")["poplin"]
    >>> fabric
    <kesf.Fabric poplin: 21 curves, 0 values of tables, 21 files>
    >>> curve = fabric.measurements[0]
    >>> curve.test, curve.direction, curve.x.shape == curve.y.shape, curve.y_unit
    ('tensile', 'warp', True, 'N/m')
    """

    def __init__(self, native: _kesf.Fabric) -> None:
        self._native = native

    @cached_property
    def _summary(self) -> dict[str, Any]:
        summary: dict[str, Any] = json.loads(self._native.summary())
        return summary

    @property
    def name(self) -> str:
        """Identifier: the name of its folder, or the stem of its file."""
        return str(self._summary["name"])

    @property
    def path(self) -> str:
        """The folder or file."""
        return str(self._summary["path"])

    @property
    def info(self) -> dict[str, Any]:
        """What ``fabric.toml`` says: title, weave, origin, stated areal density (kg/m²) and thickness (m), notes ..."""
        info: dict[str, Any] = self._summary["info"]
        return info

    @cached_property
    def measurements(self) -> tuple[Measurement, ...]:
        """Curves, ordered by test, direction and specimen."""
        return tuple(self._measurement(k, m) for k, m in enumerate(self._summary["measurements"]))

    def _measurement(self, index: int, m: dict[str, Any]) -> Measurement:
        x, y = self._native.curve(index)
        x_unit, y_unit = m["units"]
        return Measurement(
            test=m["test"],
            direction=m["direction"],
            specimen=m["specimen"],
            sample=m["sample"],
            x=_floats(x),
            y=_floats(y),
            x_unit=x_unit,
            y_unit=y_unit,
            conditions=m["conditions"],
            path=m["path"],
            metadata=m["metadata"],
        )

    @property
    def results(self) -> list[dict[str, Any]]:
        """Values of result tables (SI): parameter, direction, mean, sd, n, repeats and the cell of each."""
        results: list[dict[str, Any]] = self._summary["results"]
        return results

    @property
    def strips(self) -> int:
        """Number of FAB strip tests."""
        return int(self._summary["strips"])

    @property
    def sources(self) -> list[dict[str, Any]]:
        """Every file that was read: path, SHA-256, encoding and dialect."""
        sources: list[dict[str, Any]] = self._summary["sources"]
        return sources

    @property
    def inference(self) -> list[dict[str, Any]]:
        """What was inferred from each file and why: path and decisions."""
        inference: list[dict[str, Any]] = self._summary["inference"]
        return inference

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What a reader of the data must know."""
        return findings_of(self._native.findings())

    def curves(self, test: Test | None = None, direction: Direction | None = None, units: Units = "si") -> Table:
        """The points of its curves as a table; see :meth:`Batch.curves`."""
        return Batch([self]).curves(test, direction, units)

    def __eq__(self, other: object) -> bool:
        return self._native == other._native if isinstance(other, Fabric) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return _fabric, (_kesf.version(), self._native.packed())

    def __repr__(self) -> str:
        strips = f", {self.strips} strip tests" if self.strips else ""
        counts = f"{len(self._summary['measurements'])} curves, {len(self.results)} values of tables{strips}"
        return f"<kesf.Fabric {self.name}: {counts}, {len(self.sources)} files>"

    def _repr_html_(self) -> str:
        rows = []
        for test in ("tensile", "shear", "bending", "compression", "friction", "roughness"):
            curves = [m for m in self.measurements if m.test == test]
            if curves:
                rows.append(f"<td>{test}, {len(curves)}<br>{lines([(m.x, m.y) for m in curves], 140)}</td>")
        title = self.info.get("title") or self.name
        head = f"<b>{escape(str(title))}</b>, {len(self.results)} values of tables"
        return f"<div>{head}<table><tr>{''.join(rows)}</tr></table></div>"


def _fabric(version: str, packed: bytes) -> Fabric:
    return Fabric(_kesf.Fabric.unpacked(version, packed))


class Batch(Sequence[Fabric]):
    """Fabrics that were read together, in name order, with what was found and what could not be read.

    Attributes:
        findings: What a reader of the data must know.
        failures: What could not be read; it cost the others nothing.

    >>> import kesf
    >>> batch = kesf.read(["kesf_data/poplin", "kesf_data/twill"])
    >>> [fabric.name for fabric in batch], batch.failures
    (['poplin', 'twill'], ())
    >>> batch["twill"].name, len(batch.measurements)
    ('twill', 42)
    """

    def __init__(
        self,
        fabrics: Sequence[Fabric],
        findings: tuple[Finding, ...] = (),
        failures: tuple[Failure, ...] = (),
    ) -> None:
        self._fabrics = tuple(fabrics)
        self.findings = findings
        self.failures = failures

    @property
    def fabrics(self) -> tuple[Fabric, ...]:
        """The fabrics."""
        return self._fabrics

    @property
    def measurements(self) -> tuple[Measurement, ...]:
        """The curves of all fabrics."""
        return tuple(m for fabric in self._fabrics for m in fabric.measurements)

    def curves(self, test: Test | None = None, direction: Direction | None = None, units: Units = "si") -> Table:
        """The points of all curves as a table, those of one test and direction where these are given.

        Columns: fabric, test, direction, specimen, index (from 0 in recorded order), x, x_unit, y, y_unit,
        origin. With one test the fields ``x`` and ``y`` have their unit in the metadata.

        >>> import kesf
        >>> kesf.read("kesf_data/poplin").curves("bending", units="kes").units["x"]
        '1/cm'
        """
        for given, known in ((test, get_args(Test)), (direction, get_args(Direction))):
            if given is not None and given not in known:
                raise KesfError(f"`{given}` is none of {', '.join(known)}")
        native = [fabric._native for fabric in self._fabrics]
        return Table(_kesf.Fabric.curves(native, unit_system(units), test, direction))

    @overload
    def __getitem__(self, index: int | str) -> Fabric: ...
    @overload
    def __getitem__(self, index: slice) -> Batch: ...
    def __getitem__(self, index: int | str | slice) -> Fabric | Batch:
        """A fabric by its place or name, or some of them."""
        if isinstance(index, slice):
            return Batch(self._fabrics[index], self.findings, self.failures)
        if isinstance(index, str):
            return named(self._fabrics, index)
        return self._fabrics[index]

    def __len__(self) -> int:
        return len(self._fabrics)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Batch):
            return NotImplemented
        mine = (self._fabrics, self.findings, self.failures)
        return mine == (other._fabrics, other.findings, other.failures)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        told = f"{len(self.findings)} findings, {len(self.failures)} failures"
        return f"<kesf.Batch: {len(self)} fabrics, {told}>"

    def _repr_html_(self) -> str:
        rows = [(f.name, len(f._summary["measurements"]), len(f.results), len(f.findings)) for f in self]
        failed = html_table(("could not be read", "code", "why"), [(f.path, f.code, f.message) for f in self.failures])
        header = ("fabric", "curves", "values of tables", "findings")
        return html_table(header, rows) + (failed if self.failures else "")


def named(all_of: Sequence[Named], name: str) -> Named:
    for one in all_of:
        if one.name == name:
            return one
    names = ", ".join(one.name for one in all_of[:10])
    raise KeyError(f"no fabric `{name}`; there are {names}{' ...' if len(all_of) > 10 else ''}")
