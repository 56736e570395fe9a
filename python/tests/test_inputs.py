"""What functions are given: files that cannot be read, values of numpy, and what is none of their inputs."""

from __future__ import annotations

import json
import shutil
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kesf

#: The package, for calls that its types forbid.
anything: Any = kesf

SQUARE: dict[str, Any] = {
    "title": "square",
    "fabric": "*",
    "sheet": {"shape": "rectangle", "width": "4 cm", "height": "4 cm", "cells": np.array([4, 4])},
    "supports": [{"set": "boundary", "kind": "clamped"}],
    "loads": [{"kind": "pressure", "value": "0.01 Pa"}],
}


def damaged(tmp_path: Path) -> Path:
    """The poplin with one file that is none."""
    folder = tmp_path / "poplin"
    shutil.copytree("kesf_data/poplin", folder)
    next(path for path in sorted(folder.iterdir()) if "FB2" in path.name).write_text("no measurement\n")
    return folder


def test_files_of_a_path_that_cannot_be_read_are_told(tmp_path: Path) -> None:
    folder = damaged(tmp_path)
    name = next(path.name for path in folder.iterdir() if path.read_bytes() == b"no measurement\n")
    for made in (kesf.characterise, kesf.section, lambda path: kesf.solve(SQUARE, path)):
        with pytest.warns(kesf.KesfWarning, match=name) as told:
            made(folder)
        # The line is that of the caller.
        assert [Path(each.filename).name for each in told] == ["test_inputs.py"]
    named = kesf.solve({**SQUARE, "fabric": str(folder)})
    assert [name in str(failure.path) for failure in named.failures] == [True]
    batch = kesf.read(folder)
    assert kesf.characterise(batch).failures == batch.failures != ()


def test_cases_that_a_fabric_has_nothing_for_are_refused() -> None:
    for case, fabric in (("fab_bend_loop", "poplin"), ("virtual_compression", "petrak_m1")):
        with pytest.raises(kesf.KesfError) as refused:
            kesf.compare(f"cases/{case}.toml", f"kesf_data/{fabric}")
        assert refused.value.code == "O055"


def test_a_document_without_the_laws_of_its_section_says_so(poplin: kesf.Sheet) -> None:
    section = kesf.section(poplin, law="friction")
    read = kesf.Section.from_json(section.to_json())
    assert section.has_friction and not read.has_friction
    assert [finding.code for finding in read.findings] == ["C026"]
    again = kesf.Section.from_json(read.to_json())
    assert [finding.code for finding in again.findings] == ["C026"]
    assert "without" not in json.loads(kesf.section(poplin).to_json())["sections"][0]


def test_numbers_of_numpy_are_numbers(poplin: kesf.Sheet) -> None:
    for poisson in (np.float32(0.25), np.float64(0.25), np.array(0.25)):
        assert kesf.section(poplin, poisson=poisson) == kesf.section(poplin, poisson=0.25)
    assert kesf.solve(SQUARE, poplin).w_max > 0.0
    with pytest.raises(kesf.KesfError, match="cannot be used"):
        kesf.section(poplin, poisson=float("nan"))


def test_a_residual_curvature_without_friction_is_refused(poplin: kesf.Sheet) -> None:
    with pytest.raises(kesf.KesfError, match="friction"):
        kesf.section(poplin, residual_curvature="1 1/cm")


class Frame:
    """Like those of polars and pandas, whose parts are the names of their columns."""

    columns = ("fabric",)

    def __iter__(self) -> Any:
        return iter(self.columns)


@pytest.mark.parametrize(
    "call",
    [
        lambda _: anything.read(None),
        lambda _: anything.read(Frame()),
        lambda _: anything.read([("a.csv", 5)]),
        lambda _: anything.characterise(None),
        lambda _: anything.characterise(b"B"),
        lambda _: anything.characterise(["kesf_data/poplin"]),
        lambda _: anything.section(3),
        lambda sheets: anything.section(sheets),
        lambda sheets: anything.solve(SQUARE, sheets),
        lambda _: anything.solve(None),
        lambda _: anything.solve("title = 'text'\n[sheet]\n"),
        lambda _: anything.read("kesf_data/poplin").curves("bendign"),
        lambda _: anything.read("kesf_data/poplin").curves("bending", "wrap"),
    ],
)
def test_what_is_no_input_is_refused(call: Callable[[kesf.Sheets], object], sheets: kesf.Sheets) -> None:
    with pytest.raises(kesf.KesfError):
        call(sheets)


def test_results_show_what_they_are_of(poplin: kesf.Sheet) -> None:
    modal = {key: value for key, value in SQUARE.items() if key != "loads"} | {
        "analysis": {"kind": "modal", "modes": 1}
    }
    modes = kesf.solve(modal, poplin)
    assert "Hz" in repr(modes) and len(modes.load_factors) == 0
    pulled = SQUARE | {
        "supports": [{"set": "left", "kind": "clamped"}],
        "loads": [{"kind": "edge_force", "set": "right", "value": "1 N/m", "direction": [1, 0, 0]}],
    }
    in_plane = kesf.solve(pulled, poplin)
    assert in_plane.in_plane_max is not None and in_plane.in_plane_max > 0.0 and "in-plane" in repr(in_plane)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        shown = in_plane._repr_html_()
    assert "synthetic" in shown and "status" in poplin._repr_html_()
    assert "synthetic" in kesf.section(poplin)._repr_html_()
