"""Runs and the suite: the same digits as the command."""

from __future__ import annotations

import csv
import io
import os
import pickle
import subprocess
from pathlib import Path

import pytest

import kesf

ROOT = Path(__file__).resolve().parents[2]

#: What the order of summation may change on a machine with other vector instructions (tests/command/recorded.rs).
ROUNDING = 1e-7

#: The value of a line of the suite may itself be a rounding error.
NOISE = 1e-8


def recorded(name: str) -> list[dict[str, str]]:
    with open(ROOT / "tests" / "recorded" / name, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def is_same(column: str, expected: str, found: object) -> bool:
    if found is None:
        return expected == ""
    if isinstance(found, (int, float)):
        number = float(expected)
        # An error is a fraction of what was measured: that of a closed loop is nothing but rounding.
        size = 1.0 if column == "error" else max(abs(number), abs(found))
        return number == found or abs(number - found) <= ROUNDING * size
    return expected == found


@pytest.fixture(scope="module")
def shipped() -> kesf.Run:
    """A run of all shipped data."""
    before = os.getcwd()
    os.chdir(ROOT)
    try:
        return kesf.run("kesf_data", "cases", charts=False)
    finally:
        os.chdir(before)


@pytest.mark.parametrize("name", ["fabrics.csv", "predictions.csv"])
def test_every_number_is_the_recorded_one(shipped: kesf.Run, name: str) -> None:
    table = shipped.parameters if name == "fabrics.csv" else shipped.predictions
    # Drapes are not recorded: they end at a residual of 1e-6, and have fewer digits that stay.
    found = [row for row in table.rows() if not str(row.get("quantity", "")).startswith("drape_")]
    expected = recorded(name)
    assert len(expected) == len(found)
    for row, other in zip(expected, found, strict=True):
        assert list(row) == list(other)
        for column in row:
            assert is_same(column, row[column], other[column]), (row, column, other[column])


def test_every_file_is_that_of_the_command(shipped: kesf.Run, tmp_path: Path) -> None:
    command = os.environ.get("KESF_COMMAND") or str(ROOT / "target" / "release" / "kesf")
    if not Path(command).exists():
        pytest.skip("there is no command `kesf` to compare with; cargo build --release makes it")
    written_last = max(path.stat().st_mtime for path in (ROOT / "src").rglob("*.*"))
    if Path(command).stat().st_mtime < written_last:
        pytest.skip("the command `kesf` is older than its source; cargo build --release makes it anew")
    version = subprocess.run([command, "--version"], capture_output=True, text=True, check=True)
    assert version.stdout.split()[1] == kesf.__version__
    out = tmp_path / "results"
    done = subprocess.run(
        [command, "run", "kesf_data", "cases", "--no-charts", "-o", str(out)], capture_output=True, cwd=ROOT
    )
    assert done.returncode == 0, done.stderr
    written = {str(p.relative_to(out)): p.read_bytes() for p in out.rglob("*") if p.is_file()}
    # Hidden files are for the next run of the command.
    compared = [name for name in written if name in shipped.files]
    assert set(written) - set(compared) == {n for n in written if Path(n).name.startswith(".")}
    assert set(shipped.files) <= set(written) and len(compared) > 100
    for name in compared:
        assert shipped.files[name] == written[name], name


def test_single_calls_give_the_numbers_of_the_run(shipped: kesf.Run, sheets: kesf.Sheets) -> None:
    rows = shipped.predictions.rows()
    for case in ("seed_clamped", "virtual_shear", "cantilever", "cantilever_strip"):
        for name in ("poplin", "petrak_m1"):
            function = kesf.solve if case in ("seed_clamped", "cantilever_strip") else kesf.compare
            own = function(f"cases/{case}.toml", sheets[name]).predictions.rows()
            assert own == [row for row in rows if (row["case"], row["fabric"]) == (case, name)]
    assert sheets.parameters() == shipped.parameters


def test_charts_are_of_the_formats_that_are_asked_for_and_tables_in_a_workbook() -> None:
    inputs = ("kesf_data/petrak_m1", "cases/virtual_bending.toml")
    files = kesf.run(*inputs, formats=("svg", "pdf"), xlsx=True).files
    names = {ending: [n for n in files if n.endswith(ending)] for ending in (".png", ".svg", ".pdf")}
    assert not names[".png"] and names[".svg"]
    assert [Path(n).stem for n in names[".svg"]] == [Path(n).stem for n in names[".pdf"]]
    assert all(files[n].startswith(b"%PDF") for n in names[".pdf"])
    assert files["results.xlsx"].startswith(b"PK")
    assert "results.xlsx" not in kesf.run(*inputs, charts=False).files
    for formats in ("gif", ()):
        with pytest.raises(kesf.KesfError, match="O050"):
            kesf.run(*inputs, formats=formats)


def test_a_sheet_comes_from_a_drawing() -> None:
    # Its check is the closed form of the annular plate.
    report = kesf.run("kesf_data/petrak_m1", "examples/imported/patch.toml", charts=False)
    assert not report.failures and not report.fails_a_check
    assert "cases/patch.json" in report.files


def test_a_folder_is_written_like_the_files_in_memory(tmp_path: Path) -> None:
    inputs = ("kesf_data/petrak_m1", "cases/virtual_bending.toml")
    in_memory = kesf.run(*inputs)
    on_disk = kesf.run(*inputs, out=tmp_path / "out")
    assert on_disk.files == {} and on_disk.predictions == in_memory.predictions
    for name, data in in_memory.files.items():
        assert (tmp_path / "out" / name).read_bytes() == data, name
    assert any(name.endswith(".png") for name in in_memory.files)
    assert pickle.loads(pickle.dumps(in_memory)) == in_memory
    assert "1 fabrics" in repr(on_disk) and "B warp" in on_disk._repr_html_()
    rows = list(csv.DictReader(io.StringIO(in_memory.files["predictions.csv"].decode())))
    assert [row["quantity"] for row in rows] == in_memory.predictions["quantity"]


def test_files_of_others_are_not_overwritten(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("mine")
    with pytest.raises(kesf.KesfError) as refused:
        kesf.run("kesf_data/petrak_m1", "cases/virtual_bending.toml", out=tmp_path, charts=False)
    assert refused.value.code.startswith("O") and (tmp_path / "index.html").read_text() == "mine"
    kesf.run("kesf_data/petrak_m1", "cases/virtual_bending.toml", out=tmp_path, charts=False, force=True)
    assert (tmp_path / "index.html").read_text() != "mine"


def test_one_bad_input_costs_the_others_nothing(tmp_path: Path) -> None:
    broken = tmp_path / "broken.csv"
    broken.write_text("")
    report = kesf.run(["kesf_data/petrak_m1", broken], "cases/virtual_bending.toml", charts=False)
    assert "petrak_m1" in report.fabrics and len(report.predictions) == 2
    assert [failure.code for failure in report.failures] == ["R002"]
    assert "R002" in report.problems["code"]
    with pytest.raises(kesf.KesfError) as nothing:
        kesf.run([])
    assert nothing.value.code == "O055"
    with pytest.raises(kesf.KesfError, match="`magic` is no solver"):
        kesf.run("kesf_data/petrak_m1", solver="magic")


def test_nothing_but_bad_inputs_is_told(tmp_path: Path) -> None:
    broken = tmp_path / "broken.csv"
    broken.write_text("")
    report = kesf.run(broken)
    assert [failure.code for failure in report.failures] == report.problems["code"] == ["R002"]


def test_drapes_are_left_out_and_it_is_said() -> None:
    cases = ["cases/drape.toml", "cases/virtual_bending.toml"]
    for drape, word in ((None, "quick drapes for 0 of 1"), (False, "")):
        report = kesf.run("kesf_data/petrak_m1", cases, charts=False, drape=drape)
        assert len(report.predictions) == 2 and any(word in note for note in [*report.notes, ""])


def test_the_suite_gives_the_recorded_numbers() -> None:
    suite = kesf.verify("patch")
    assert suite.passed and len(suite) > 10 and "lines hold" in repr(suite)
    values = {row["id"]: float(row["value"]) for row in recorded("verify.csv")}
    # Lines that came after the table was recorded are held by the suite itself.
    known = [line for line in suite if line["id"] in values]
    assert len(known) > 10
    for line in known:
        expected, found = values[line["id"]], line["value"]
        both_noise = abs(expected) < NOISE and abs(found) < NOISE
        assert both_noise or is_same("value", repr(expected), found), line
    with pytest.raises(kesf.KesfError, match="no line of the suite"):
        kesf.verify("nothing like it")
