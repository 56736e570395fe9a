"""Sections: fabrics as shells, and as material files of other programs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from . import _kesf
from ._calls import json_of
from ._errors import Finding, KesfError, findings_of
from ._html import findings as html_findings
from ._html import table as html_table
from ._types import Floats, Path


@dataclass(frozen=True)
class Assumption:
    """An input or assumption behind a section.

    Attributes:
        name: What it is, such as ``tensile modulus``.
        value: Its value with unit.
        provenance: ``measured``, ``inferred``, ``stated`` or ``assumed``.
        source: That and why, for people.
    """

    name: str
    value: str
    provenance: str
    source: str

    @property
    def is_assumed(self) -> bool:
        """Whether it is a choice or a stand-in, and no property of the fabric."""
        return self.provenance == "assumed"


class Section:
    """The stiffness of a fabric as an orthotropic shell; made by :func:`kesf.section`. x is the warp, y the weft.

    Engineering strains: ``N = d_m [ε_x, ε_y, γ_xy]``, ``M = d_b [κ_x, κ_y, κ_xy]`` with ``κ_xy = -2 w,xy``, and
    ``Q = d_s [γ_xz, γ_yz]``. It pickles as what it was made of, and is made again to the last digit.

    >>> import kesf
    >>> section = kesf.section(kesf.characterise("kesf_data/poplin"), poisson=0.2)
    >>> section.d_m.shape, section.d_b.shape, section.d_s.shape
    ((3, 3), (3, 3), (2, 2))
    >>> [a.value for a in section.assumptions if a.name == "Poisson's ratio"]
    ['nu12 0.2923, nu21 0.1368']
    """

    def __init__(self, native: _kesf.Section) -> None:
        self._native = native

    @classmethod
    def from_json(cls, text: str | bytes) -> Section:
        """The section of a document ``kesf.section/1`` with one fabric."""
        text = text.decode() if isinstance(text, bytes) else text
        sections = _kesf.Section.of_document(text)
        if len(sections) != 1:
            raise KesfError(f"the document has {len(sections)} sections", cure="write one section into a document")
        return cls(sections[0])

    def to_json(self) -> str:
        """The document ``kesf.section/1``, as ``kesf section -o section.json`` writes it."""
        return self._native.document()

    @cached_property
    def _entry(self) -> dict[str, Any]:
        entry: dict[str, Any] = json.loads(self._native.document())["sections"][0]
        return entry

    def _matrix(self, name: str) -> Floats:
        matrix = np.array(self._entry[name], dtype=np.float64)
        matrix.setflags(write=False)
        return matrix

    @property
    def name(self) -> str:
        """The fabric."""
        return str(self._entry["fabric"])

    @property
    def origin(self) -> str:
        """``measured``, ``published`` or ``synthetic``."""
        return str(self._entry["origin"])

    @cached_property
    def d_m(self) -> Floats:
        """Membrane stiffness (N/m), shape (3, 3), read-only."""
        return self._matrix("d_m")

    @cached_property
    def d_b(self) -> Floats:
        """Bending stiffness (N·m), shape (3, 3), read-only."""
        return self._matrix("d_b")

    @cached_property
    def d_s(self) -> Floats:
        """Transverse shear stiffness (N/m), shape (2, 2), read-only."""
        return self._matrix("d_s")

    @property
    def areal_density(self) -> float:
        """Mass per area (kg/m²)."""
        return float(self._entry["areal_density"])

    @property
    def thickness(self) -> float:
        """Thickness (m)."""
        return float(self._entry["thickness"])

    @property
    def assumptions(self) -> tuple[Assumption, ...]:
        """Inputs and assumptions in the order in which they were used."""
        return tuple(Assumption(name, **entry) for name, entry in self._entry["assumptions"].items())

    @property
    def uncertainty(self) -> list[dict[str, Any]]:
        """Entries on and above the diagonals with their 95 % bands, in their own units."""
        uncertainty: list[dict[str, Any]] = self._entry["uncertainty"]
        return uncertainty

    @property
    def has_friction(self) -> bool:
        """Whether bending and shear have friction (``law`` of the assumptions)."""
        return self._native.has_law

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What a reader of the section must know; findings of the sheet are the sheet's."""
        return findings_of(self._native.findings())

    def __eq__(self, other: object) -> bool:
        return self._native == other._native if isinstance(other, Section) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return _section, (_kesf.version(), self._native.packed())

    def __repr__(self) -> str:
        b = f"B {self.d_b[0, 0]:.3g} and {self.d_b[1, 1]:.3g} N·m"
        e = f"D_m {self.d_m[0, 0]:.4g} and {self.d_m[1, 1]:.4g} N/m"
        assumed = sum(a.is_assumed for a in self.assumptions)
        return f"<kesf.Section {self.name}: {b}, {e}, {assumed} assumptions, {self.origin} data>"

    def _repr_html_(self) -> str:
        parts = []
        for name, unit, matrix in (("D_m", "N/m", self.d_m), ("D_b", "N·m", self.d_b), ("D_s", "N/m", self.d_s)):
            header = [""] * len(matrix)
            parts.append(html_table(header, matrix.tolist(), f"{name} ({unit})"))
        rows = [(a.name, a.value, a.provenance, a.source) for a in self.assumptions]
        caption = f"{self.name}, {self.origin} data"
        table = html_table(("input", "value", "provenance", "source"), rows, caption)
        return "".join(parts) + table + html_findings(self.findings)


def _section(version: str, packed: bytes) -> Section:
    return Section(_kesf.Section.unpacked(version, packed))


@dataclass(frozen=True)
class Card:
    """A fabric as a material file of another program; made by :func:`kesf.export`.

    Attributes:
        fabric: Its name.
        program: The program.
        ending: Ending of the files that the program expects.
        text: The file.
        findings: What the program cannot hold of the fabric, with the size of what is lost.
    """

    fabric: str
    program: str
    ending: str
    text: str = field(repr=False)
    findings: tuple[Finding, ...] = field(default=(), repr=False)

    def write(self, path: Path) -> None:
        """Writes the file, in UTF-8."""
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(self.text)

    def _repr_html_(self) -> str:
        """The lines of the file, the first of them where there are many, and what it cannot hold."""
        rows = list(enumerate(self.text.splitlines(), 1))
        caption = f"{self.fabric} for {self.program} ({self.ending}), {len(self.text.encode())} bytes"
        return html_table(("line", "text"), rows, caption, 12) + html_findings(self.findings)


def assumptions_of(given: Mapping[str, Any]) -> str:
    """Assumptions as JSON."""
    try:
        return json_of({name: value for name, value in given.items() if value is not None})
    except (TypeError, ValueError) as error:
        raise KesfError(f"the assumptions cannot be used: {error}") from error
