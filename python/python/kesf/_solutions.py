"""Solutions of cases: solved sheets and drapes."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ._data import RawOutcome, Result, arrays_of
from ._errors import Failure, Finding, failures_of, findings_of
from ._html import findings as html_findings
from ._html import lines
from ._html import table as html_table
from ._table import Table, predictions_html
from ._types import Floats, Indices


@dataclass(frozen=True, eq=False)
class Mesh(Result):
    """The mesh of a sheet.

    Attributes:
        nodes: Places of the nodes at rest (m), shape (nodes, 3).
        elements: The four nodes of each element, counted from 0, shape (elements, 4); the last two of a triangle are
            the same.
    """

    nodes: Floats
    elements: Indices

    def __repr__(self) -> str:
        return f"<kesf.Mesh: {len(self.nodes)} nodes, {len(self.elements)} elements>"

    def _repr_html_(self) -> str:
        """Its size, and the elements seen from above, where that many can be told apart."""
        low, high = self.nodes.min(axis=0), self.nodes.max(axis=0)
        rows = [(axis, float(a), float(b)) for axis, a, b in zip("xyz", low, high, strict=True)]
        across, up = (float(size) or 1.0 for size in (high - low)[:2])
        scale = 160.0 / max(across, up)
        # Every so many elements: a picture of thousands would be grey, and megabytes.
        shown = self.elements[:: max(1, len(self.elements) // 800)]
        rims = [(self.nodes[rim, 0], self.nodes[rim, 1]) for rim in np.hstack([shown, shown[:, :1]])]
        picture = lines(rims, round(across * scale) + 4, round(up * scale) + 4, ("#1a1a1a",))
        caption = f"{len(self.nodes)} nodes, {len(self.elements)} elements"
        return html_table(("", "from (m)", "to (m)"), rows, caption) + picture


@dataclass(frozen=True)
class Probe:
    """What was found at a named point; components are those of the sheet's axes, x = warp.

    Attributes:
        at: The point (m), two or three coordinates.
        u: Displacement (m).
        theta: Rotation (rad).
        moment: Moments x, y, xy per width (N).
        membrane: Membrane forces x, y, xy per width (N/m).
        shear: Transverse shear forces x, y per width (N/m).
    """

    at: tuple[float, ...]
    u: tuple[float, float, float]
    theta: tuple[float, float, float]
    moment: tuple[float, float, float]
    membrane: tuple[float, float, float]
    shear: tuple[float, float]

    @property
    def w(self) -> float:
        """Deflection (m)."""
        return self.u[2]


@dataclass(frozen=True, eq=False)
class Solution(Result):
    """A solved case, in SI; made by :func:`kesf.solve`.

    Attributes:
        document: Its entry of ``kesf.solution/1``: model, solver, results, checks, steps, history.
        predictions: Its rows of ``predictions.csv``.
        history: Probes and energies against load factor or time; empty for a linear case.
        findings: What a reader of the result must know, of the section and of the solution.
        failures: What failed within it: a search that did not reach its end; of a fabric that the case names, files
            that could not be read.
        arrays: Every field by name; the properties say which.

    >>> import kesf
    >>> solution = kesf.solve("cases/benchmark_clamped_orthotropic.toml")
    >>> solution.status, solution.displacement.shape == (len(solution.mesh.nodes), 6)
    ('ok', True)
    >>> all(check["passed"] for check in solution.checks)
    True
    """

    document: dict[str, Any] = field(repr=False)
    predictions: Table = field(repr=False)
    history: Table = field(repr=False)
    findings: tuple[Finding, ...] = field(repr=False)
    failures: tuple[Failure, ...] = field(repr=False)
    arrays: dict[str, NDArray[Any]] = field(repr=False)

    @property
    def case(self) -> str:
        """Name of the case."""
        return str(self.document["case"])

    @property
    def fabric(self) -> str | None:
        """Name of the fabric; None for a case with constants of its own."""
        fabric: str | None = self.document["fabric"]
        return fabric

    @property
    def status(self) -> Literal["ok", "beyond_linear", "check_failed", "not_converged"]:
        """How the case ended: ``ok``, ``beyond_linear``, ``check_failed`` or ``not_converged``."""
        status: Literal["ok", "beyond_linear", "check_failed", "not_converged"] = self.document["status"]
        return status

    @property
    def mesh(self) -> Mesh:
        """Nodes and elements."""
        return Mesh(self.arrays["nodes"], self.arrays["elements"])

    @property
    def displacement(self) -> Floats:
        """Displacements u, v, w (m) and rotations (rad) of the nodes, shape (nodes, 6); of vibrations and buckling the
        first shape, which has no size."""
        return self.arrays["displacement"]

    @property
    def w(self) -> Floats:
        """Deflection of the nodes (m), shape (nodes,)."""
        return self.displacement[:, 2]

    @property
    def position(self) -> Floats | None:
        """Places of the nodes at the end (m), shape (nodes, 3); of large rotations only."""
        return self.arrays.get("position")

    @property
    def reaction(self) -> Floats | None:
        """Forces (N) and moments (N·m) of the supports on the nodes, shape (nodes, 6); none of modes and motions."""
        return self.arrays.get("reaction")

    @property
    def membrane(self) -> Floats:
        """Membrane forces x, y, xy per width at the nodes (N/m), material axes, shape (nodes, 3)."""
        return self.arrays["membrane"]

    @property
    def moment(self) -> Floats:
        """Moments x, y, xy per width at the nodes (N), material axes, shape (nodes, 3)."""
        return self.arrays["moment"]

    @property
    def shear(self) -> Floats:
        """Transverse shear forces x, y per width at the nodes (N/m), material axes, shape (nodes, 2)."""
        return self.arrays["shear"]

    @property
    def element_membrane(self) -> Floats:
        """Means over the elements of what ``membrane`` has at nodes (N/m), shape (elements, 3)."""
        return self.arrays["element_membrane"]

    @property
    def element_moment(self) -> Floats:
        """Means over the elements of what ``moment`` has at nodes (N), shape (elements, 3)."""
        return self.arrays["element_moment"]

    @property
    def element_shear(self) -> Floats:
        """What ``shear`` has at nodes, at the centres of the elements (N/m), shape (elements, 2)."""
        return self.arrays["element_shear"]

    @property
    def frequencies(self) -> Floats:
        """Natural frequencies (Hz), ascending; empty but for a modal analysis."""
        return self.arrays["frequencies"]

    @property
    def load_factors(self) -> Floats:
        """Factors of the loads at which the sheet buckles (1), ascending; empty but for a buckling analysis."""
        return np.array(self.document["results"].get("load_factors") or [], dtype=np.float64)

    @property
    def modes(self) -> Floats | None:
        """Shapes of vibrations or buckling, (modes, nodes, 6), with a largest displacement of 1; they have no size."""
        return self.arrays.get("modes")

    @property
    def profile(self) -> tuple[Floats, Floats]:
        """Distance along the middle line (m) and deflection there (m)."""
        return self.arrays["profile_x"], self.arrays["profile_w"]

    @property
    def w_max(self) -> float:
        """The largest |w| with its sign (m); of vibrations and buckling that of a shape, which has no size."""
        return float(self.document["results"]["w_max"]["value"])

    @property
    def in_plane_max(self) -> float | None:
        """The largest displacement within the plane (m), of a sheet that stays in it; else None."""
        found = self.document["results"].get("in_plane_max")
        return None if found is None else float(found["value"])

    @property
    def strain_energy(self) -> float | None:
        """Strain energy (J); none of a modal analysis."""
        energy: float | None = self.document["results"]["strain_energy"]
        return energy

    @property
    def reactions(self) -> tuple[float, float, float] | None:
        """Sum of the forces of the supports (N); none of modes and motions."""
        forces = self.document["results"]["reactions"]
        return None if forces is None else tuple(forces)

    @property
    def probes(self) -> dict[str, Probe]:
        """Named points and what was found there."""
        probes = self.document["results"]["probes"].items()
        return {name: Probe(**{key: tuple(value) for key, value in entry.items()}) for name, entry in probes}

    @property
    def checks(self) -> list[dict[str, Any]]:
        """Checks of the case: quantity, value, expected, unit, error, tolerance and whether each passed."""
        checks: list[dict[str, Any]] = self.document["checks"]
        return checks

    @property
    def uncertainty(self) -> dict[str, Any] | None:
        """How certain the results are, of measured inputs; None where that is not known."""
        uncertainty: dict[str, Any] | None = self.document["results"]["uncertainty"]
        return uncertainty

    def __repr__(self) -> str:
        of = f" of {self.fabric}" if self.fabric else ""
        return f"<kesf.Solution {self.case}{of}: {self.status}, {self._first}, {self.mesh!r}>"

    @property
    def _first(self) -> str:
        """What is looked at first."""
        if len(self.frequencies):
            return f"first frequency {self.frequencies[0]:.4g} Hz"
        if len(self.load_factors):
            return f"first load factor {self.load_factors[0]:.4g}"
        if self.in_plane_max is not None:
            return f"in-plane displacement up to {self.in_plane_max:.4g} m"
        return f"w_max {self.w_max:.4g} m"

    def _repr_html_(self) -> str:
        caption = f"{self.case} {self.fabric or ''}: {self.status}"
        return predictions_html(self.predictions, caption) + lines([self.profile]) + html_findings(self.findings)


@dataclass(frozen=True, eq=False)
class Drape(Result):
    """A draped sheet, in SI; made by :func:`kesf.drape`.

    Attributes:
        document: Its entry of ``kesf.solution/1``.
        predictions: Its rows of ``predictions.csv``.
        findings: What a reader of the result must know.
        failures: Files of its fabric that could not be read.
        arrays: Fields of the finest state by name; the properties say which.
    """

    document: dict[str, Any] = field(repr=False)
    predictions: Table = field(repr=False)
    findings: tuple[Finding, ...] = field(repr=False)
    failures: tuple[Failure, ...] = field(repr=False)
    arrays: dict[str, NDArray[Any]] = field(repr=False)

    @property
    def case(self) -> str:
        """Name of the case."""
        return str(self.document["case"])

    @property
    def fabric(self) -> str | None:
        """Name of the fabric; None for a case with constants of its own."""
        fabric: str | None = self.document["fabric"]
        return fabric

    @property
    def _values(self) -> dict[str, Any]:
        values: dict[str, Any] = self.document["results"]["drape"]
        return values

    @property
    def coefficient(self) -> float:
        """Drape coefficient of the state of lowest energy on the finest mesh, 0 to 1."""
        return float(self._values["coefficient"])

    @property
    def band(self) -> tuple[float, float]:
        """Least and greatest coefficient of all states that were found."""
        low, high = self._values["band"]
        return float(low), float(high)

    @property
    def measured(self) -> float | None:
        """The measured coefficient, 0 to 1, if there is one."""
        measured = self._values["measured"]
        return None if measured is None else float(measured["value"])

    @property
    def states(self) -> list[dict[str, Any]]:
        """Every equilibrium on the mesh of the case, lowest energy first."""
        states: list[dict[str, Any]] = self._values["states"]
        return states

    @property
    def folds(self) -> int:
        """Number of folds of the finest state."""
        return int(self._values["finest"]["nodes"])

    @property
    def mesh(self) -> Mesh:
        """Nodes and elements at rest."""
        return Mesh(self.arrays["nodes"], self.arrays["elements"])

    @property
    def position(self) -> Floats:
        """Places of the nodes of the draped sheet (m), shape (nodes, 3)."""
        return self.arrays["position"]

    @property
    def outline(self) -> Floats:
        """Distance of the shadow's outline from the axis (m), one for each degree from x, shape (360,)."""
        return self.arrays["outline"]

    def __repr__(self) -> str:
        low, high = self.band
        of = f" of {self.fabric}" if self.fabric else ""
        return (
            f"<kesf.Drape {self.case}{of}: coefficient {self.coefficient:.3f} ({low:.3f} to {high:.3f}), "
            f"{self.folds} folds>"
        )

    def _repr_html_(self) -> str:
        angle = np.linspace(0.0, 2.0 * np.pi, len(self.outline) + 1)
        rim = np.append(self.outline, self.outline[:1])
        shadow = lines([(rim * np.cos(angle), rim * np.sin(angle))], 120, 120)
        return (
            predictions_html(self.predictions, f"{self.case} {self.fabric or ''}")
            + shadow
            + html_findings(self.findings)
        )


def solution_of(raw: RawOutcome) -> Solution:
    """The solution of a native simulation."""
    document, predictions, history, arrays, findings, failures = raw
    return Solution(
        document=json.loads(document)["solutions"][0],
        predictions=Table(predictions),
        history=Table(history),
        findings=findings_of(findings),
        failures=failures_of(failures),
        arrays=arrays_of(arrays),
    )


def drape_of(raw: RawOutcome) -> Drape:
    """The drape of a native simulation."""
    document, predictions, _, arrays, findings, failures = raw
    return Drape(
        document=json.loads(document)["solutions"][0],
        predictions=Table(predictions),
        findings=findings_of(findings),
        failures=failures_of(failures),
        arrays=arrays_of(arrays),
    )
