"""Cases: solutions, comparisons and drapes, and what becomes of wrong ones."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kesf

#: A clamped square of the shipped benchmark, coarse.
SQUARE: dict[str, Any] = {
    "title": "Clamped square",
    "source": "D = 1 N·m, L = 1 m",
    "section": {
        "tensile_warp": "10.92e6 N/m",
        "tensile_weft": "10.92e6 N/m",
        "poisson": 0.3,
        "shear": "4.2e6 N/m",
        "bending_warp": "1 N·m",
        "bending_weft": "1 N·m",
        "bending_coupling": "0.3 N·m",
        "torsion": "0.35 N·m",
        "transverse_shear": "3.5e6 N/m",
        "areal_density": "1 kg/m²",
        "thickness": "1 mm",
    },
    "sheet": {"shape": "rectangle", "width": "1 m", "height": "1 m", "cells": [20, 20]},
    "supports": [{"set": "boundary", "kind": "clamped"}],
    "loads": [{"kind": "pressure", "value": "0.001 Pa"}],
    "probes": [{"name": "centre", "at": ["0.5 m", "0.5 m"]}],
}

#: A round sheet over a disc.
DRAPE = Path("cases/drape.toml")


def test_a_case_of_data_is_solved_and_its_fields_are_arrays() -> None:
    solution = kesf.solve(SQUARE)
    assert solution.status == "ok" and solution.fabric is None
    # Clamped square plate: w = 0.00126531908748 q L^4 / D (Hencky's series).
    assert solution.probes["centre"].w == pytest.approx(1.26531908748e-6, rel=5e-3)
    nodes = 21 * 21
    assert solution.mesh.nodes.shape == (nodes, 3) and solution.mesh.elements.shape == (400, 4)
    assert solution.mesh.elements.max() == nodes - 1
    assert solution.displacement.shape == (nodes, 6) and solution.moment.shape == (nodes, 3)
    assert solution.shear.shape == (nodes, 2) and solution.element_membrane.shape == (400, 3)
    assert solution.position is None and solution.modes is None and not len(solution.frequencies)
    # The supports carry the load, node by node and in the sum.
    assert solution.reaction is not None and solution.reactions is not None
    assert solution.reaction[:, 2].sum() == pytest.approx(-1e-3, rel=1e-9)
    assert solution.reactions[2] == pytest.approx(-1e-3, rel=1e-9)
    assert solution.w_max == solution.w[np.abs(solution.w).argmax()]
    x, w = solution.profile
    assert len(x) == len(w) and w.max() == pytest.approx(solution.w_max, rel=1e-3)
    assert pickle.loads(pickle.dumps(solution)) == solution
    assert "Clamped" not in repr(solution) and "w_max" in repr(solution) and "<svg" in solution._repr_html_()


def test_natural_frequencies_and_modes() -> None:
    case = {key: value for key, value in SQUARE.items() if key not in ("loads", "probes")}
    solution = kesf.solve({**case, "analysis": {"kind": "modal", "modes": 3}})
    # Clamped square plate: 35.985 / (2 pi) sqrt(D / (rho t)) / L^2 (Leissa).
    assert solution.frequencies[0] == pytest.approx(35.985 / (2.0 * np.pi), rel=5e-3)
    assert solution.modes is not None and solution.modes.shape == (3, 441, 6)
    assert np.abs(solution.modes[:, :, :3]).max() == pytest.approx(1.0, rel=1e-9)
    assert solution.reaction is None and solution.reactions is None and solution.strain_energy is None


def test_large_rotations_have_places_and_a_history() -> None:
    solution = kesf.solve("cases/self_weight_clamped.toml")
    assert solution.position is not None
    np.testing.assert_allclose(solution.position, solution.mesh.nodes + solution.displacement[:, :3], atol=1e-12)
    assert set(solution.history["quantity"]) >= {"w_max", "strain_energy"}
    assert solution.history.units["factor"] == "1"
    assert all(check["passed"] for check in solution.checks)


def test_a_case_is_a_file_bytes_or_data(poplin: kesf.Sheet) -> None:
    path = Path("cases/seed_clamped.toml")
    by_path = kesf.solve(path, poplin)
    in_memory = kesf.solve(path.read_bytes(), poplin)
    assert np.array_equal(by_path.displacement, in_memory.displacement)
    assert by_path.uncertainty is not None and by_path.fabric == "poplin"


def test_a_section_keeps_its_assumptions_and_a_sheet_takes_those_of_the_case(poplin: kesf.Sheet) -> None:
    case = Path("cases/seed_clamped.toml").read_text()
    assuming = (case + "\n[assumptions]\nbending_coupling = 0.3\n").encode()
    as_case = kesf.solve(assuming, poplin)
    as_section = kesf.solve(case.encode(), kesf.section(poplin, bending_coupling=0.3))
    plain = kesf.solve(case.encode(), poplin)
    assert np.array_equal(as_case.displacement, as_section.displacement)
    assert as_case.uncertainty == as_section.uncertainty
    # The section that is given stands, whatever the case assumes.
    given = kesf.solve(assuming, kesf.section(poplin))
    assert np.array_equal(given.displacement, plain.displacement)
    assert not np.array_equal(as_case.displacement, plain.displacement)


def test_threads_change_no_digit(poplin: kesf.Sheet) -> None:
    one, two = (kesf.solve("cases/seed_simply_supported.toml", poplin, threads=n) for n in (1, 2))
    assert np.array_equal(one.displacement, two.displacement)


def test_comparisons_have_curves_and_errors(poplin: kesf.Sheet) -> None:
    comparison = kesf.compare("cases/virtual_bending.toml", poplin)
    (warp, weft) = comparison.curves
    assert warp.name == "bending warp" and warp.x.shape == warp.measured.shape == warp.simulated.shape
    measured = poplin["B", "warp"].mean
    assert comparison.predictions["measured"][0] == measured
    # The slope of the simulated line is the rigidity of the sheet.
    slope = np.polyfit(warp.x, warp.simulated, 1)[0]
    assert measured is not None and slope == pytest.approx(measured, rel=1e-3)
    assert weft.r2 is not None and pickle.loads(pickle.dumps(comparison)) == comparison
    assert "B warp" in repr(comparison) and "<svg" in comparison._repr_html_()
    cantilever = kesf.compare("cases/cantilever.toml", poplin)
    assert cantilever.curves == [] and cantilever.entries[0]["cantilever"]["overhang"]["value"] > 0.0


def test_a_drape_has_states_and_an_outline(poplin: kesf.Sheet) -> None:
    drape = kesf.drape(coarse_drape(), poplin)
    low, high = drape.band
    assert 0.0 < low <= drape.coefficient <= high < 1.0
    assert drape.outline.shape == (360,) and drape.position.shape == drape.mesh.nodes.shape
    # (A_shadow - A_disc) / (A_sheet - A_disc), with the area of the outline by sectors of a degree.
    sectors = 0.5 * np.sin(np.radians(1.0)) * drape.outline * np.roll(drape.outline, -1)
    disc, sheet = np.pi * 0.09**2, np.pi * 0.15**2
    assert drape.coefficient == pytest.approx((sectors.sum() - disc) / (sheet - disc), abs=0.01)
    assert drape.states[0]["start_folds"] == 4 and drape.states[0]["elements"] == len(drape.mesh.elements)
    assert pickle.loads(pickle.dumps(drape)) == drape
    assert "<svg" in drape._repr_html_() and "folds" in repr(drape)


def coarse_drape() -> bytes:
    """The shipped drape on few elements and from one number of folds."""
    # As text: a reader of TOML came with Python 3.11 only.
    text = DRAPE.read_text(encoding="utf-8")
    for shipped, coarse in (
        ("cells = [14, 90]", "cells = [6, 32]"),
        ("folds = [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]", "folds = [4]"),
        ("refinements = 1", "refinements = 0"),
    ):
        assert shipped in text, shipped
        text = text.replace(shipped, coarse)
    return text.encode()


@pytest.mark.parametrize(
    ("change", "code", "what"),
    [
        ({"title": None}, "S002", "title"),
        ({"loads": [{"kind": "pressure", "value": "0.001 Pax"}]}, "S002", "Pax"),
        ({"sheet": {**SQUARE["sheet"], "cells": [20]}}, "S002", "array of length 2"),
        ({"supports": []}, "S003", "nothing holds the sheet"),
    ],
)
def test_a_wrong_case_is_told_with_its_place(change: dict[str, Any], code: str, what: str) -> None:
    case = {key: value for key, value in {**SQUARE, **change}.items() if value is not None}
    with pytest.raises(kesf.KesfError) as refused:
        kesf.solve(case)
    error = refused.value
    assert error.code == code and error.cure, error
    assert what in error.message and error.path == "<case>", error


def test_cases_go_to_their_functions(poplin: kesf.Sheet) -> None:
    for function, path in [
        (kesf.solve, "cases/drape.toml"),
        (kesf.drape, "cases/virtual_bending.toml"),
        (kesf.compare, "cases/seed_clamped.toml"),
    ]:
        with pytest.raises(kesf.KesfError, match="is no case for") as refused:
            function(path, poplin)
        assert refused.value.cure is not None and refused.value.cure.startswith("give it to kesf.")
    with pytest.raises(kesf.KesfError, match="is for a fabric, and none is given"):
        kesf.solve("cases/seed_clamped.toml")
    with pytest.raises(kesf.KesfError, match="has constants of its own"):
        kesf.solve(SQUARE, poplin)
    with pytest.raises(kesf.KesfError) as missing:
        kesf.solve("cases/nowhere.toml")
    assert missing.value.path == "cases/nowhere.toml"
    with pytest.raises(kesf.KesfError, match="cannot be written as TOML"):
        kesf.solve({"sheet": {"cells": object()}})


def test_a_case_that_names_its_fabric_needs_no_other(tmp_path: Path) -> None:
    text = Path("cases/seed_clamped.toml").read_text().replace('fabric = "*"', 'fabric = "kesf_data/poplin"')
    named = kesf.solve(text.encode())
    given = kesf.solve(text.encode(), "kesf_data/twill")
    assert (named.fabric, given.fabric) == ("poplin", "twill")
    with pytest.raises(kesf.KesfError, match="there is no fabric `nowhere`"):
        kesf.solve(text.replace("kesf_data/poplin", "nowhere").encode())
