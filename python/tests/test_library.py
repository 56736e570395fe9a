"""A library that answers, and the commands for a scheduler of jobs."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import kesf

polars = pytest.importorskip("polars")
pytest.importorskip("pyarrow")
pytest.importorskip("fsspec")

from kesf import library  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]

#: The command, where it is built.
KESF = ROOT / "target" / "release" / "kesf"

#: The parameters of a fabric's hand (Kawabata, The Standardization and Analysis of Hand Evaluation, 1980), and whether
#: their logarithm is taken.
SPACE = {
    "LT": False,
    "WT": True,
    "RT": False,
    "B": True,
    "2HB": True,
    "G": True,
    "2HG": True,
    "2HG5": True,
    "LC": False,
    "WC": True,
    "RC": False,
    "MIU": False,
    "MMD": True,
    "SMD": True,
    "T0": True,
    "W": True,
}


@pytest.fixture()
def shipped(sheets: kesf.Sheets, tmp_path: Path) -> Path:
    path = tmp_path / "library.parquet"
    assert library.build(path, sheets) == 13
    return path


def test_a_library_has_a_row_a_fabric_in_kes_units(shipped: Path, sheets: kesf.Sheets) -> None:
    import pyarrow.parquet

    schema = pyarrow.parquet.read_schema(shipped)
    assert schema.field("B_warp").metadata == {b"unit": "gf·cm²/cm".encode()}
    assert schema.field("thickness").metadata == {b"unit": b"mm"}
    frame = polars.read_parquet(shipped)
    expected = polars.DataFrame(sheets.parameters("kes", wide=True)).sort("fabric")
    for name in expected.columns[1:]:
        if name != "origin" and not name.endswith("_status"):
            status = frame[f"{name}_status"]
            assert set(status.drop_nulls()) <= {"measured", "inferred", "assumed", "doubtful"}
            assert status.is_null().to_list() == frame[name].is_null().to_list()
        for found, value in zip(frame[name], expected[name], strict=True):
            assert (found is None) == (value is None)
            assert found in (None, value) or found == pytest.approx(value, rel=1e-11), name


def test_results_of_all_kinds_make_the_same_library(shipped: Path, sheets: kesf.Sheets, tmp_path: Path) -> None:
    expected = polars.read_parquet(shipped)
    kesf.run("kesf_data", (), tmp_path / "run", charts=False)
    from kesf import dask

    for task in dask.plan("kesf_data", (), tmp_path / "parts", 3):
        dask.work(task)
    kinds: list[Any] = [tmp_path / "run", tmp_path / "parts", kesf.evaluate("kesf_data")]
    for number, results in enumerate(kinds):
        path = tmp_path / f"{number}.parquet"
        assert library.build(path, results) == 13
        found = polars.read_parquet(path).select(expected.columns)
        assert found.equals(expected), results
    with pytest.raises(kesf.KesfError, match="is in sheets 1 too"):
        library.build(tmp_path / "two.parquet", sheets, sheets[:1])
    with pytest.raises(kesf.KesfError, match="these are no results") as nothing:
        library.build(tmp_path / "none.parquet", tmp_path / "nowhere")
    assert nothing.value.code == "O069"
    with pytest.raises(kesf.KesfError, match="there is no fabric"):
        library.build(tmp_path / "none.parquet")


def test_bounds_are_sql_in_kes_units(shipped: Path) -> None:
    frame = polars.read_parquet(shipped)
    wanted = (frame["thickness"] < 0.6) & (frame["B_warp"] < 0.12)
    names = frame.filter(wanted)["fabric"].to_list()
    assert 0 < len(names) < 13
    assert library.find(shipped, where="thickness < 0.6 and B_warp < 0.12")["fabric"].to_list() == names
    quoted = library.find(shipped, where='"2HB_warp" < 0.05')
    assert quoted.height and library.find(shipped, where="2HB_warp < 0.05").equals(quoted)
    for wrong in ("thickness <", "tickness < 0.4"):
        with pytest.raises(kesf.KesfError, match="the bounds cannot be used") as refused:
            library.find(shipped, where=wrong)
        assert "thickness" in refused.value.message and refused.value.code == "O071"
    # Without a limit all are there, and what bounds leave out is told.
    assert library.find(shipped).height == 13 and library.find(shipped, n=2).height == 2
    unknown = frame["LT_warp"].null_count()
    assert unknown > 1
    with pytest.warns(kesf.KesfWarning, match=f"{unknown} fabrics have no LT_warp"):
        library.find(shipped, where="LT_warp > 0")
    with pytest.warns(kesf.KesfWarning, match="no origin is `Measured`: it is published or synthetic"):
        assert library.find(shipped, where="origin = 'Measured'").is_empty()
    with pytest.raises(kesf.KesfError, match="did you mean `B_warp`"):
        library.find(shipped, where="b_warp < 1")
    with pytest.raises(kesf.KesfError, match="the library cannot be read"):
        library.find(shipped.with_name("nowhere.parquet"))


def by_hand(frame: Any, a: str, b: str) -> tuple[float, int]:
    """The distance of two fabrics, written out once more."""

    def scaled(value: float | None, logarithm: bool) -> float | None:
        if value is None or (logarithm and value <= 0.0):
            return None
        return math.log10(value) if logarithm else float(value)

    def sides(row: dict[str, Any], symbol: str) -> tuple[float | None, float | None]:
        return row.get(f"{symbol}_warp"), row.get(f"{symbol}_weft")

    def coordinate(row: dict[str, Any], symbol: str, logarithm: bool) -> float | None:
        values = [v for v in sides(row, symbol) if v is not None]
        return scaled(sum(values) / len(values) if values else row.get(symbol), logarithm)

    def pair(x: dict[str, Any], y: dict[str, Any], symbol: str) -> list[float | None]:
        common = [k for k in (0, 1) if None not in (sides(x, symbol)[k], sides(y, symbol)[k])]
        if len(common) == 1:
            return [sides(x, symbol)[common[0]], sides(y, symbol)[common[0]]]
        both = [None not in sides(row, symbol) for row in (x, y)]
        return [
            sum(v for v in sides(row, symbol) if v is not None) / 2 if whole else row.get(symbol)
            for row, whole in zip((x, y), both, strict=True)
        ]

    rows = {row["fabric"]: row for row in frame.to_dicts()}
    squares = []
    for symbol, logarithm in SPACE.items():
        known = [c for c in (coordinate(row, symbol, logarithm) for row in rows.values()) if c is not None]
        x, y = (scaled(value, logarithm) for value in pair(rows[a], rows[b], symbol))
        if x is None or y is None or len(known) < 2:
            continue
        mean = sum(known) / len(known)
        deviation = math.sqrt(sum((k - mean) ** 2 for k in known) / (len(known) - 1))
        squares.append(((x - y) / deviation) ** 2)
    return math.sqrt(sum(squares) / len(squares)), len(squares)


def test_the_nearest_fabrics_come_first(shipped: Path, sheets: kesf.Sheets) -> None:
    found = library.find(shipped, like="poplin", n=20)
    names = found["fabric"].to_list()
    assert "poplin" not in names and found["distance"].is_sorted()
    frame = polars.read_parquet(shipped)
    for row in found.to_dicts():
        distance, count = by_hand(frame, "poplin", row["fabric"])
        assert row["distance"] == pytest.approx(distance, rel=1e-12) and row["parameters"] == count
    # The same fabric by its sheet or path is itself the nearest.
    for like in (sheets["poplin"], "kesf_data/poplin", kesf.read("kesf_data/poplin")[0]):
        nearest = library.find(shipped, like=like, n=1).to_dicts()[0]
        assert nearest["fabric"] == "poplin" and nearest["distance"] == pytest.approx(0.0, abs=1e-9)
    bounded = library.find(shipped, like="poplin", where="thickness < 0.6")
    assert set(bounded["fabric"]) <= set(names) and (bounded["thickness"] < 0.6).all()
    # What is asked for does not change what is usual in the library.
    kept = dict(zip(names, found["distance"], strict=True))
    assert all(kept[row["fabric"]] == row["distance"] for row in bounded.to_dicts())
    with pytest.raises(kesf.KesfError, match="no fabric `denim` in the library"):
        library.find(shipped, like="denim")


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "kesf", *arguments], capture_output=True, text=True, check=False)


def test_shards_are_made_merged_and_asked_from_a_shell(tmp_path: Path) -> None:
    out, case = str(tmp_path / "out"), "cases/virtual_bending.toml"
    for shard in ("1/3", "2/3", "3/3"):
        done = command("evaluate", "kesf_data", "--cases", case, "--shard", shard, "-o", out)
        assert done.returncode == 0 and f"shard {shard}" in done.stderr, done.stderr
    again = command("evaluate", "kesf_data", "--cases", case, "--shard", "2/3", "-o", out)
    assert "is there already" in again.stderr
    whole = tmp_path / "whole.parquet"
    assert command("merge", out, "-o", str(whole)).returncode == 0
    one = str(tmp_path / "one")
    assert command("evaluate", "kesf_data", "--cases", case, "-o", one).returncode == 0
    single = tmp_path / "single.parquet"
    assert command("merge", one, "-o", str(single)).returncode == 0
    assert whole.read_bytes() == single.read_bytes()
    fabrics = str(tmp_path / "library.parquet")
    assert "13 fabrics" in command("library", "build", fabrics, out).stderr
    found = command("library", "find", fabrics, "--like", "poplin", "--where", "thickness < 0.6", "-n", "2")
    lines = found.stdout.splitlines()
    assert lines[0].startswith("fabric,distance,parameters") and len(lines) == 3


def test_the_command_reads_what_python_writes_and_the_other_way_round(tmp_path: Path) -> None:
    if not KESF.exists():
        pytest.skip("the command is not built; cargo build --release")

    def kesf_command(*arguments: str) -> None:
        done = subprocess.run([KESF, *arguments], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr

    out, case = str(tmp_path / "out"), "cases/virtual_bending.toml"
    assert command("evaluate", "kesf_data", "--cases", case, "--shard", "1/2", "-o", out).returncode == 0
    kesf_command("run", "kesf_data", case, "--shard", "2/2", "-o", out)
    kesf_command("merge", out, "-o", str(tmp_path / "command.parquet"))
    assert command("merge", out, "-o", str(tmp_path / "python.parquet")).returncode == 0
    assert (tmp_path / "command.parquet").read_bytes() == (tmp_path / "python.parquet").read_bytes()
    kesf_command("library", "build", str(tmp_path / "command.library"), out)
    assert library.build(tmp_path / "python.library", out) == 13
    assert (tmp_path / "command.library").read_bytes() == (tmp_path / "python.library").read_bytes()
    found = str(tmp_path / "found.parquet")
    arguments = ("--like", "poplin", "--where", "thickness < 0.6", "-n", "5")
    kesf_command("library", "find", str(tmp_path / "command.library"), *arguments, "-o", found)
    asked = library.find(tmp_path / "python.library", like="poplin", where="thickness < 0.6", n=5)
    assert polars.read_parquet(found).equals(asked)


def test_a_wrong_command_says_what_is_wrong(tmp_path: Path) -> None:
    out = str(tmp_path / "out")
    wrong = command("evaluate", "kesf_data", "--shard", "4/3", "-o", out)
    assert wrong.returncode == 2 and "`4/3` is no shard; the third of seven is 3/7" in wrong.stderr
    missing = command("evaluate", "nowhere", "-o", out)
    assert missing.returncode == 2 and "nowhere: R001" in missing.stderr
    assert command("merge", out, "-o", "x.parquet").returncode == 2
