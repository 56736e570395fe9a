"""Fabrics, sheets and sections: attributes, text, equality, pickles."""

from __future__ import annotations

import dataclasses
import json
import pickle
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kesf


def round_trip(thing: object) -> object:
    return pickle.loads(pickle.dumps(thing))


def test_a_batch_has_fabrics_findings_and_failures_as_data(tmp_path: Path) -> None:
    broken = tmp_path / "broken.csv"
    broken.write_text("")
    batch = kesf.read(["kesf_data/poplin", broken])
    assert [fabric.name for fabric in batch] == ["poplin"]
    (failure,) = batch.failures
    assert (failure.code, failure.path) == ("R002", str(broken))
    assert failure.cure
    assert isinstance(failure.error(), kesf.KesfError)
    assert "1 failures" in repr(batch) and "R002" in batch._repr_html_()


def test_curves_are_those_of_the_file() -> None:
    fabric = kesf.read("kesf_data/poplin")["poplin"]
    curve = next(m for m in fabric.measurements if m.test == "bending")
    assert curve.x.dtype == np.float64 and not curve.x.flags.writeable
    # The file is in KES units: curvature (1/cm) and moment per width (gf·cm/cm).
    lines = [line for line in Path(curve.path).read_text().splitlines() if line and line[0] in "-0123456789"]
    x, y = np.array([[float(cell) for cell in line.split(",")] for line in lines]).T
    np.testing.assert_allclose(curve.x, 100.0 * x, rtol=1e-12)
    np.testing.assert_allclose(curve.y, 9.80665e-3 * y, rtol=1e-12)


def test_bytes_are_read_like_a_file() -> None:
    path = Path("kesf_data/petrak_m1/results.csv")
    by_path, in_memory = kesf.read(path)[0], kesf.read((path.name, path.read_bytes()))[0]
    assert by_path.results[0]["mean"] == in_memory.results[0]["mean"]
    assert kesf.read(path.read_bytes())[0].sources[0]["sha256"] == by_path.sources[0]["sha256"]


def test_settings_of_reading_are_used(tmp_path: Path) -> None:
    text = "K,M\n" + "\n".join(f"{k / 10},{k / 200}" for k in range(26))
    path = tmp_path / "warp.csv"
    path.write_text(text)
    with pytest.raises(kesf.KesfError) as refused:
        kesf.read(path)
    assert refused.value.code.startswith("R")
    with pytest.raises(kesf.KesfError, match="decimal mark"):
        kesf.read(path, decimal=";")
    with pytest.raises(kesf.KesfError, match="one character"):
        kesf.read(path, delimiter=", ")


def test_what_is_nothing_to_read_is_told() -> None:
    with pytest.raises(kesf.KesfError, match="int is nothing to read"):
        kesf.read([3])  # type: ignore[list-item]
    with pytest.raises(kesf.KesfError) as nothing:
        kesf.read([])
    assert nothing.value.code == "O055" and nothing.value.cure


def test_a_broken_file_is_told_with_its_place(tmp_path: Path) -> None:
    path = tmp_path / "poplin_warp_FB2_1.csv"
    text = Path("kesf_data/poplin/poplin_warp_FB2_1.csv").read_text().splitlines()
    row = next(k for k, line in enumerate(text) if line and line[0] in "-0123456789") + 5
    text[row] = text[row].split(",")[0] + ",12x4"
    path.write_text("\n".join(text))
    with pytest.raises(kesf.KesfError) as refused:
        kesf.read(path)
    error = refused.value
    assert (error.code, error.path, error.line) == ("R004", str(path), row + 1)
    assert error.column is not None and error.cure
    again = round_trip(error)
    assert isinstance(again, kesf.KesfError)
    assert (str(again), again.line, again.fields) == (str(error), error.line, error.fields)


def test_sheets_are_those_of_the_command(sheets: kesf.Sheets, poplin: kesf.Sheet) -> None:
    b = poplin["B", "warp"]
    assert b.unit == "N·m" and b.n == 3 and b.sd and b.mean and b.cv == b.sd / b.mean
    assert poplin.get("B", "bias") is None
    with pytest.raises(KeyError, match="poplin has no B bias; it has LT warp"):
        poplin["B", "bias"]
    assert poplin.moduli["secant"]["warp"].unit == "N/m"
    assert json.loads(poplin.to_json())["schema"] == "kesf.sheet/1"
    assert "B warp" not in repr(poplin) and "poplin" in repr(poplin)
    assert "2HB" in poplin._repr_html_() and "B_warp" in sheets._repr_html_()
    with pytest.raises(KeyError, match="no fabric `denim`"):
        sheets["denim"]


def test_settings_come_as_file_bytes_or_data(tmp_path: Path) -> None:
    text = 'bending_slope = ["0.5 1/cm", "1.0 1/cm"]\n'
    path = tmp_path / "settings.toml"
    path.write_text(text)
    data = {"bending_slope": ["0.5 1/cm", "1.0 1/cm"]}
    fabric = kesf.read("kesf_data/poplin")[0]
    three = [kesf.characterise(fabric, given) for given in (path, text.encode(), data)]
    assert three[0]["B", "warp"] == three[1]["B", "warp"] == three[2]["B", "warp"]
    assert three[0]["B", "warp"] != kesf.characterise(fabric)["B", "warp"]
    with pytest.raises(kesf.KesfError) as refused:
        kesf.characterise(fabric, b'\nbending_slope = ["1.0 1/cm", "0.5 1/cm"]\n')
    assert (refused.value.code, refused.value.line) == ("O050", 2)


def test_two_fabrics_of_one_name_are_told_apart() -> None:
    one = kesf.read("kesf_data/petrak_m1")[0]
    sheets = kesf.characterise([one, one])
    assert [sheet.name for sheet in sheets] == ["petrak_m1", "petrak_m1-2"]
    assert round_trip(sheets) == sheets


def test_a_path_of_several_fabrics_is_refused() -> None:
    with pytest.raises(kesf.KesfError, match="there are 13 fabrics"):
        kesf.characterise("kesf_data")


def test_sections_are_checked_and_say_what_they_assume(poplin: kesf.Sheet) -> None:
    section = kesf.section(poplin, poisson=0.2, torsion="3e-6 N·m")
    assert section.d_b[2, 2] == 3e-6 and section.d_m.shape == (3, 3)
    assert np.array_equal(section.d_m, section.d_m.T) and not section.d_m.flags.writeable
    assert any(a.is_assumed for a in section.assumptions)
    assert section.uncertainty[0]["matrix"] == "d_m"
    assert "poplin" in repr(section) and "D_b" in section._repr_html_()
    for wrong, what in [({"torsion": "hubber"}, "C008"), ({"torsions": "huber"}, "unknown field")]:
        with pytest.raises(kesf.KesfError, match=what):
            kesf.section(poplin, **wrong)
    with pytest.raises(kesf.KesfError) as refused:
        kesf.section(poplin, poisson=1.5)
    assert refused.value.code == "C006"


def test_a_section_takes_a_modulus_that_the_sheet_was_not_made_with(poplin: kesf.Sheet) -> None:
    window = "window(5 gf/cm, 50 gf/cm)"
    late = kesf.section(poplin, modulus=window)
    early = kesf.section(kesf.characterise("kesf_data/poplin", moduli=[window]), modulus=window)
    assert np.array_equal(late.d_m, early.d_m)
    assert not np.array_equal(late.d_m, kesf.section(poplin).d_m)


def test_documents_come_back(poplin: kesf.Sheet) -> None:
    sheet = kesf.Sheet.from_json(poplin.to_json())
    assert sheet.values == poplin.values
    section, again = kesf.section(poplin), kesf.section(sheet)
    assert np.array_equal(section.d_b, again.d_b)
    assert np.array_equal(kesf.Section.from_json(section.to_json()).d_m, section.d_m)
    with pytest.raises(kesf.KesfError, match="no kesf.sheet/1"):
        kesf.Sheet.from_json(section.to_json())
    with pytest.raises(kesf.KesfError, match="no kesf.section/1"):
        kesf.Section.from_json("{}")


def test_everything_pickles_and_compares(sheets: kesf.Sheets, poplin: kesf.Sheet) -> None:
    batch = kesf.read(["kesf_data/poplin", "kesf_data/petrak_m1"])
    section = kesf.section(poplin, law="friction")
    things: list[object] = [
        batch,
        batch[0],
        batch[0].measurements[0],
        poplin,
        sheets,
        section,
        kesf.Sheet.from_json(poplin.to_json()),
        kesf.Section.from_json(section.to_json()),
        poplin.parameters(),
        kesf.export(section, "u3m"),
        poplin["B", "warp"],
    ]
    for thing in things:
        again = round_trip(thing)
        assert again == thing, thing
        assert thing != object() and thing != 3
    assert batch[0] != batch[1] and sheets[0] != sheets[1]
    assert kesf.section(poplin, poisson=0.1) != kesf.section(poplin)
    assert section.has_friction and round_trip(section).has_friction  # type: ignore[attr-defined]
    assert batch[0].inference == round_trip(batch[0]).inference  # type: ignore[attr-defined]


def test_markup_in_names_stays_text(tmp_path: Path) -> None:
    folder = tmp_path / "<script>alert(1)<"
    shutil.copytree("kesf_data/poplin", folder)
    info = (folder / "fabric.toml").read_text(encoding="utf-8")
    named = re.sub(r"(?m)^name = .*$", 'name = "<script>alert(2)"', info)
    assert named != info
    (folder / "fabric.toml").write_text(named, encoding="utf-8")
    fabric = kesf.read(folder)[0]
    sheet = kesf.characterise(fabric)
    card = kesf.export(sheet, "abaqus")
    shown: list[Any] = [fabric, sheet, kesf.Sheets([sheet]), kesf.section(sheet), card, fabric.measurements[0]]
    direction: Any = "<script>"
    shown += [dataclasses.replace(fabric.measurements[0], direction=direction), kesf.read([folder])]
    for thing in shown:
        html = thing._repr_html_()
        assert "<script" not in html and "<" in html, thing
    assert "&lt;script&gt;alert(2)" in fabric._repr_html_() and "&lt;script&gt;alert(2)" in sheet._repr_html_()


def test_notebooks_show_pictures_and_tables(poplin: kesf.Sheet, sheets: kesf.Sheets) -> None:
    # A picture for each of the tests that have curves, and none without.
    assert poplin._repr_html_().count("<svg") == len({m.test for m in kesf.read("kesf_data/poplin").measurements})
    assert "<svg" not in sheets["petrak_m1"]._repr_html_()
    card = kesf.export(poplin, "calculix")
    assert "<table" in card._repr_html_() and card.text.splitlines()[0].split()[0] in card._repr_html_()
    mesh = kesf.solve("cases/benchmark_clamped_orthotropic.toml").mesh
    assert "<svg" in mesh._repr_html_() and f"{len(mesh.elements)} elements" in mesh._repr_html_()
    assert len(mesh._repr_html_()) < 100_000


def test_an_error_keeps_its_failures_in_a_pickle() -> None:
    with pytest.raises(kesf.KesfError) as raised:
        kesf.read(["nowhere.csv", "neither.csv"])
    again = round_trip(raised.value)
    assert isinstance(again, kesf.KesfError)
    assert str(again) == str(raised.value)
    assert len(again.failures) == 2 and again.failures == raised.value.failures


def test_the_pickle_of_another_version_is_refused(poplin: kesf.Sheet) -> None:
    from kesf import _kesf

    with pytest.raises(ValueError, match="written by kesf 0.0.1 and this is"):
        _kesf.Sheet.unpacked("0.0.1", poplin._native.packed())


def test_cards_are_those_of_the_command(poplin: kesf.Sheet, tmp_path: Path) -> None:
    for program in kesf.targets():
        card = kesf.export(poplin, program)
        assert card.text and card.program == program
    card = kesf.export(poplin, "calculix", tmp_path / "poplin.inp")
    assert (tmp_path / "poplin.inp").read_bytes() == card.text.encode()
    with pytest.raises(kesf.KesfError, match="take one of abaqus"):
        kesf.export(poplin, "excel")
    with pytest.raises(kesf.KesfError, match="a section has its assumptions"):
        kesf.export(kesf.section(poplin), "u3m", poisson=0.1)


def test_codes_are_explained() -> None:
    assert kesf.explain("r008")["cure"]
    with pytest.raises(kesf.KesfError, match="`X999` is no code"):
        kesf.explain("X999")
