"""Tables cross to the programs of data frames by Arrow, with units."""

from __future__ import annotations

import builtins
import importlib.util
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import kesf


@pytest.fixture()
def tables(sheets: kesf.Sheets) -> dict[str, kesf.Table]:
    report = kesf.run("kesf_data/petrak_m1", "cases/virtual_bending.toml", charts=False)
    return {
        "curves": kesf.read("kesf_data/poplin").curves(),
        "parameters": sheets.parameters(),
        "wide": sheets.parameters(wide=True),
        "predictions": report.predictions,
        "problems": report.problems,
        "history": kesf.solve("cases/self_weight_clamped.toml").history,
        "empty": kesf.solve("cases/benchmark_clamped_isotropic.toml").history,
    }


def test_a_table_is_what_its_rows_are(tables: dict[str, kesf.Table]) -> None:
    for table in tables.values():
        assert pickle.loads(pickle.dumps(table)) == table
        assert len(table.rows()) == len(table)
        assert table.column_names == list(table.to_pydict())
        assert str(len(table)) in repr(table) and "<table" in table._repr_html_()
    assert tables["empty"].column_names[0] == "step" and len(tables["empty"]) == 0
    assert tables["parameters"] != tables["wide"]
    with pytest.raises(KeyError, match="no column `B`; there are fabric"):
        tables["parameters"]["B"]


def test_units_are_in_the_metadata(tables: dict[str, kesf.Table]) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    field = pyarrow.table(tables["wide"]).schema.field("B_warp")
    assert field.metadata == {b"unit": "N·m".encode()}
    field = pyarrow.table(tables["parameters"]).schema.field("mean")
    assert field.metadata == {b"unit_column": b"unit"}
    field = pyarrow.table(tables["predictions"]).schema.field("simulated")
    assert field.metadata == {b"unit": "N·m".encode(), b"unit_column": b"unit"}
    bending = kesf.read("kesf_data/poplin").curves("bending", "warp", units="kes")
    assert bending.units["x"] == "1/cm" and bending.units["y"] == "gf·cm/cm"
    assert set(bending["direction"]) == {"warp"}
    with pytest.raises(kesf.KesfError, match="no system of units"):
        kesf.read("kesf_data/poplin").curves(units="imperial")  # type: ignore[arg-type]


def test_polars_takes_every_table(tables: dict[str, kesf.Table]) -> None:
    polars = pytest.importorskip("polars")
    for table in tables.values():
        frame = polars.DataFrame(table)
        assert frame.columns == table.column_names
        assert frame.to_dict(as_series=False) == table.to_pydict()


def test_pyarrow_and_pandas_take_every_table(tables: dict[str, kesf.Table]) -> None:
    pyarrow, pandas = pytest.importorskip("pyarrow"), pytest.importorskip("pandas")
    for table in tables.values():
        taken = pyarrow.table(table)
        taken.validate(full=True)
        assert taken.to_pydict() == table.to_pydict()
        frame = taken.to_pandas()
        assert list(frame.columns) == table.column_names and len(frame) == len(table)
        if hasattr(pandas.DataFrame, "from_arrow"):
            assert pandas.DataFrame.from_arrow(table).shape == frame.shape


def test_duckdb_asks_a_table(tables: dict[str, kesf.Table]) -> None:
    duckdb = pytest.importorskip("duckdb")
    parameters = tables["parameters"]
    found = duckdb.sql("select count(*), max(mean) from parameters where parameter = 'B'").fetchall()
    means = [r["mean"] for r in parameters.rows() if r["parameter"] == "B"]
    assert found == [(len(means), max(means))]


def test_daft_takes_every_table(tables: dict[str, kesf.Table]) -> None:
    daft = pytest.importorskip("daft")
    for table in tables.values():
        # From the stream itself: not through pyarrow.
        assert daft.from_arrow(table).to_pydict() == table.to_pydict()


def test_a_missing_engine_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    importer, missing = builtins.__import__, ""

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name.split(".")[0] == missing:
            raise ImportError(name)
        return importer(name, *rest, **more)

    from kesf import dask, library, parts

    monkeypatch.setattr(builtins, "__import__", without)
    calls: dict[str, Callable[[], object]] = {
        "fsspec": lambda: parts.write_file("memory://table.parquet", b""),
        "pyarrow": lambda: parts.merge(str(tmp_path)),
        "polars": lambda: library.find(tmp_path / "library.parquet"),
        "distributed": lambda: dask.run("kesf_data", (), tmp_path / "out"),
    }
    if importlib.util.find_spec("fsspec") is None:
        # Where several are missing, the first is told.
        del calls["distributed"]
    for missing, call in calls.items():
        with pytest.raises(kesf.KesfError, match=f"{missing} is not installed") as refused:
            call()
        assert refused.value.code == "O053" and refused.value.cure is not None
        assert refused.value.cure.startswith("pip install") and missing in refused.value.cure
    # The disk does not need it.
    missing = "fsspec"
    parts.write_file(str(tmp_path / "folder" / "table.parquet"), b"PAR1")
    assert (tmp_path / "folder" / "table.parquet").read_bytes() == b"PAR1"


def test_a_stream_is_taken_once_and_a_table_often(tables: dict[str, kesf.Table]) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    table = tables["parameters"]
    first, second = pyarrow.table(table), pyarrow.table(table)
    # The same memory: nothing was copied.
    addresses = [t.column("mean").chunk(0).buffers()[1].address for t in (first, second)]
    assert addresses[0] == addresses[1]
    del table, tables
    assert first.column("mean").to_pylist() == second.column("mean").to_pylist()


def test_a_capsule_that_nobody_takes_is_let_go(tables: dict[str, kesf.Table]) -> None:
    capsules: list[Any] = [tables["parameters"].__arrow_c_stream__() for _ in range(1000)]
    capsules += [tables["parameters"].__arrow_c_schema__() for _ in range(1000)]
    del capsules
