"""Figures and the example scripts."""

from __future__ import annotations

import builtins
import csv
import importlib.util
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import kesf

ROOT = Path(__file__).resolve().parents[2]


def example(name: str) -> ModuleType:
    path = ROOT / "python" / "examples" / f"{name}.py"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("test", ["tensile", "shear", "bending", "compression"])
def test_a_figure_shows_every_specimen(poplin: kesf.Sheet, test: Any) -> None:
    pytest.importorskip("matplotlib")
    figure = poplin.plot(test)
    (axes,) = figure.axes
    drawn: list[Any] = [line for line in axes.lines if line.get_color() != "#1a1a1a"]
    data = poplin.curves(test)
    assert len(drawn) == sum(len(s["branches"]) for s in data["specimens"])
    # One point of each curve, in the units of the axes.
    starts = {(round(float(x[0]), 9), round(float(y[0]), 9)) for x, y in (line.get_data() for line in drawn)}
    for specimen in data["specimens"]:
        for branch in specimen["branches"]:
            x, y = branch["curve"]["x"][0] / data["factors"][0], branch["curve"]["y"][0] / data["factors"][1]
            assert (round(x, 9), round(y, 9)) in starts
    assert data["units"][0] in axes.get_xlabel() and "synthetic data" in axes.get_title()


def test_a_figure_takes_axes(poplin: kesf.Sheet, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    from matplotlib.figure import Figure

    figure = Figure()
    axes = figure.add_subplot()
    assert poplin.plot("shear", axes) is figure and axes.lines
    figure.savefig(tmp_path / "figure.png")


def test_what_cannot_be_drawn_is_told(sheets: kesf.Sheets, monkeypatch: pytest.MonkeyPatch) -> None:
    published = sheets["petrak_m1"]
    with pytest.raises(kesf.KesfError, match="no recorded curve of the bending test"):
        published.plot("bending")
    assert sheets["matsudaira_a_cotton_broad"].chart("bending").startswith(b"\x89PNG")
    with pytest.raises(kesf.KesfError, match="neither curves nor the values B and 2HB"):
        published.chart("bending")
    with pytest.raises(ValueError, match="`bend` is no test"):
        published.plot("bend")  # type: ignore[arg-type]
    importer = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name.startswith("matplotlib"):
            raise ImportError(name)
        return importer(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(kesf.KesfError, match="matplotlib is not installed"):
        sheets["poplin"].plot("bending")


def test_the_chart_is_that_of_a_run(poplin: kesf.Sheet) -> None:
    files = kesf.run("kesf_data/poplin").files
    assert poplin.chart("compression") == files["poplin/compression.png"]


def test_a_folder_becomes_a_figure(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    out = tmp_path / "figure.pdf"
    made = example("folder_to_figure").main("kesf_data/poplin", "cases/virtual_bending.toml", str(out))
    assert out.read_bytes().startswith(b"%PDF") and len(made.curves) == 2


def test_the_torsion_study(tmp_path: Path) -> None:
    out = tmp_path / "study.csv"
    rows = example("torsion_study").main("kesf_data/poplin", str(out))
    with open(out, encoding="utf-8", newline="") as file:
        written = list(csv.DictReader(file))
    assert [float(row["corner"]) for row in written] == [row["corner"] for row in rows]

    def spread(load: str, probe: str) -> float:
        values = np.array([row[probe] for row in rows if row["load"] == load], dtype=float)
        return float(np.ptp(values) / np.abs(values).min())

    # More torsional rigidity, less deflection of the loaded corner; the middle under an even load feels little of it.
    at_corner = [float(row["corner"]) for row in rows if row["load"] == "corner"]
    assert at_corner == sorted(at_corner, reverse=True)
    assert spread("weight", "middle") < 0.1 * spread("corner", "corner")
