"""A library on a cluster: the same tables whatever the shards, whatever happens to the workers."""

from __future__ import annotations

import errno
import io
import os
import shutil
import signal
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import kesf

pyarrow = pytest.importorskip("pyarrow")
parquet = pytest.importorskip("pyarrow.parquet")
pytest.importorskip("fsspec")
distributed = pytest.importorskip("distributed")

from kesf import dask, parts  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
CASE = "cases/virtual_bending.toml"


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """300 fabrics: the published ones under other names, some in a lot of their own, and a file that is broken."""
    root = tmp_path_factory.mktemp("library")
    published = sorted(p for p in (ROOT / "kesf_data").iterdir() if (p / "results.csv").exists())
    for number in range(300):
        source = published[number % len(published)]
        folder = root / f"lot{number % 3}" / f"{source.name}_{number:03d}"
        shutil.copytree(source, folder)
    # Of one name: told apart the same way, whatever the shards.
    for lot in ("lot1", "lot2"):
        shutil.copytree(published[0], root / lot / "twin")
    (root / "lot0" / "broken").mkdir()
    (root / "lot0" / "broken" / "broken.csv").write_text("a;b\n1;x\n")
    return root


@pytest.fixture(scope="session")
def client() -> Iterator[Any]:
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def as_bytes(out: Path) -> list[bytes]:
    return [parts.merge_file(str(out), table) for table in parts.TABLES]


def test_an_evaluation_is_what_a_run_gives() -> None:
    done = kesf.evaluate("kesf_data", CASE)
    report = kesf.run("kesf_data", CASE, charts=False)
    predicted = [row for row in done.results.rows() if row["case"]]
    assert [row["value"] for row in predicted] == report.predictions["simulated"]
    assert [row["measured"] for row in predicted] == report.predictions["measured"]
    measured = [row for row in done.results.rows() if not row["case"]]
    assert [row["value"] for row in measured] == report.parameters["mean"]
    assert len(done.findings) + len(done.failures) == len(report.problems)
    assert pyarrow.table(done).num_rows == len(done)


def test_a_table_of_files_is_evaluated(tmp_path: Path) -> None:
    path = Path("kesf_data/petrak_m1/results.csv")
    by_path = kesf.evaluate(pyarrow.table({"path": ["kesf_data/petrak_m1"]}), CASE)
    assert by_path == kesf.evaluate(["kesf_data/petrak_m1"], CASE)
    files = pyarrow.table({"path": ["petrak_m1.csv"], "content": [path.read_bytes()]})
    in_memory = kesf.evaluate(files)
    values = [row["value"] for row in by_path.results.rows() if not row["case"]]
    assert [v for v in in_memory.results["value"] if v not in values] == []
    polars = pytest.importorskip("polars")
    assert kesf.evaluate(polars.DataFrame({"path": ["kesf_data/petrak_m1"]}), CASE) == by_path
    with pytest.raises(kesf.KesfError, match="no column `path` and no column `fabric`; it has file"):
        kesf.evaluate(pyarrow.table({"file": ["a"]}))


def test_a_table_of_curves_is_evaluated() -> None:
    batch = kesf.read("kesf_data/poplin")
    by_path = kesf.evaluate("kesf_data/poplin")
    expected = {(row["quantity"], row["direction"]): row for row in by_path.results.rows()}
    for curves in (batch.curves(), pyarrow.table(batch.curves())):
        done = kesf.evaluate(curves)
        found = {(row["quantity"], row["direction"]): row for row in done.results.rows()}
        # Areal density is in fabric.toml, which a table of curves has not.
        assert set(expected) - set(found) == {("W", None)}
        for name, row in found.items():
            assert row["value"] == pytest.approx(expected[name]["value"], rel=1e-12), name
            assert row["n"] == expected[name]["n"] and row["unit"] == expected[name]["unit"]
    kes = kesf.evaluate(batch.curves(units="kes"), CASE)
    for row in kes.results.rows():
        if row["case"]:
            # A simulated test needs no areal density, and a strip between its clamps has the measured rigidity.
            assert row["value"] == pytest.approx(row["measured"], rel=1e-3), row
        else:
            name = row["quantity"], row["direction"]
            assert row["value"] == pytest.approx(expected[name]["value"], rel=1e-9)
    # The section needs it, and says so.
    assert any("areal density" in row["message"] for row in kes.failures.rows()), kes.failures.rows()
    table = pyarrow.table(batch.curves())
    wrong = table.set_column(table.column_names.index("x_unit"), "x_unit", pyarrow.array(["gf"] * len(table)))
    with pytest.raises(kesf.KesfError, match="row 1 of the table of curves .*the unit is `gf`") as refused:
        kesf.evaluate(wrong)
    assert refused.value.code == "O073"
    with pytest.raises(kesf.KesfError, match="no column `path` and no column `y`"):
        kesf.evaluate(table.drop_columns(["y"]))
    empty = table.set_column(table.column_names.index("y"), "y", pyarrow.array([None] * len(table), pyarrow.float64()))
    with pytest.raises(kesf.KesfError, match="row 1 of the table of curves has no y"):
        kesf.evaluate(empty)


def test_parts_of_different_runs_are_refused(tmp_path: Path) -> None:
    for case, shard in ((CASE, 0), ("cases/virtual_shear.toml", 1)):
        dask.work(dask.plan("kesf_data/petrak_m1", case, tmp_path, 2)[shard])
    with pytest.raises(kesf.KesfError, match="of other inputs, cases or settings") as refused:
        parts.merge(str(tmp_path))
    assert refused.value.code == "O066"


def test_what_only_the_whole_batch_tells_is_told_once(client: Any, tmp_path: Path) -> None:
    cases = [
        "cases/virtual_bending_friction.toml",
        "cases/fab_bend_loop.toml",
        "cases/benchmark_clamped_isotropic.toml",
    ]
    for shards in (1, 3):
        dask.run("kesf_data", cases, tmp_path / str(shards), client, shards=shards)
    assert as_bytes(tmp_path / "1") == as_bytes(tmp_path / "3")
    whole = kesf.evaluate("kesf_data", cases)
    results = parts.merge(str(tmp_path / "3"))
    assert sorted(map(str, whole.results.rows())) == sorted(map(str, results.to_pylist()))
    said = parts.merge(str(tmp_path / "3"), "findings").to_pylist()
    assert [row["message"] for row in said if row["code"] == "S118"] == [
        row["message"] for row in whole.findings.rows() if row["code"] == "S118"
    ]


def test_any_number_of_shards_gives_the_same_bytes(library: Path, client: Any, tmp_path: Path) -> None:
    found = []
    for shards in (1, 2, 7):
        out = tmp_path / str(shards)
        done = dask.run(library, CASE, out, client, shards=shards)
        assert [one.shard.number for one in done] == list(range(1, shards + 1))
        assert sum(one.fabrics for one in done) == 303 and not any(one.kept for one in done)
        found.append(as_bytes(out))
    assert found[0] == found[1] == found[2]
    results, findings, failures = (parts.merge(str(tmp_path / "7"), t) for t in ("results", "findings", "failures"))
    names = set(results.column("fabric").to_pylist())
    assert len(names) == 302 and {"twin", "twin-2"} <= names
    assert findings.num_rows and any("broken.csv" in place for place in failures.column("place").to_pylist())
    # The numbers are those of a plain run over the whole folder.
    whole = kesf.evaluate([library], CASE, threads=2)
    assert sorted(map(str, whole.results.rows())) == sorted(map(str, results.to_pylist()))


def test_a_killed_worker_costs_nothing(library: Path, tmp_path: Path) -> None:
    expected = tmp_path / "expected"
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as cluster,
        distributed.Client(cluster) as client,
    ):
        dask.run(library, CASE, expected, client, shards=7)
        out = tmp_path / "out"
        victim = next(iter(client.run(os.getpid).values()))

        def kill_half_way() -> None:
            while len(list(out.glob("part-*.parquet"))) < 3:
                time.sleep(0.002)
            os.kill(victim, signal.SIGKILL)

        killer = threading.Thread(target=kill_half_way)
        killer.start()
        done = dask.run(library, CASE, out, client, shards=7)
        killer.join()
        with pytest.raises(ProcessLookupError):
            os.kill(victim, 0)
    assert len(done) == 7 and as_bytes(out) == as_bytes(expected)
    assert not list(out.rglob("*.half"))


def test_progress_is_told_to_a_function_and_to_a_bar(library: Path, client: Any, tmp_path: Path) -> None:
    told: list[tuple[str, int, int]] = []
    dask.run(library / "lot0", CASE, tmp_path, client, shards=5, progress=lambda *step: told.append(step))
    assert told == [("shards", done, 5) for done in range(6)]
    tqdm = pytest.importorskip("tqdm")
    with tqdm.tqdm(file=io.StringIO()) as bar:
        assert all(one.kept for one in dask.run(library / "lot0", CASE, tmp_path, client, shards=5, progress=bar))
        assert (bar.n, bar.total, bar.desc) == (5, 5, "shards: ")

    def refuse(what: str, done: int, of: int) -> None:
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        dask.run(library / "lot0", CASE, tmp_path / "other", client, shards=5, progress=refuse)


def test_the_dashboard_shows_shards_as_one_bar(library: Path, tmp_path: Path) -> None:
    pytest.importorskip("bokeh")
    from distributed.dashboard.components.scheduler import TaskProgress

    seen: list[tuple[int, int]] = []
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as cluster,
        distributed.Client(cluster) as client,
    ):
        # What the page of the dashboard draws, from the scheduler that it draws it of.
        page = TaskProgress(cluster.scheduler)

        def look(what: str, done: int, of: int) -> None:
            page.update()
            rows = dict(zip(page.source.data["name"], range(100), strict=False))
            if "kesf-shard" in rows:
                at = rows["kesf-shard"]
                seen.append((page.source.data["memory"][at], page.source.data["all"][at]))

        dask.run(library, CASE, tmp_path, client, shards=20, progress=look)
    print("finished and all of the bar:", seen)
    # The first look may be earlier than the last task.
    totals = [total for _, total in seen]
    assert totals == sorted(totals) and totals[-1] == 20, "what is finished stays in the bar"
    finished = [done for done, _ in seen]
    assert finished == sorted(finished) and finished[-1] == 20 and len(set(finished)) > 5


#: What the memory of a worker may grow by where it evaluates five times as many fabrics in shards of one size.
FLAT = 1.15


@pytest.mark.skipif(sys.platform != "linux", reason="the most memory of a process is told in other units elsewhere")
def test_memory_of_the_workers_is_flat(library: Path, tmp_path: Path) -> None:
    for number in range(5):
        shutil.copytree(library, tmp_path / "five" / f"times{number}")

    def held() -> int:
        import resource

        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    def most(inputs: Path, shards: int) -> float:
        """The most memory that a worker has held (MB)."""
        with (
            distributed.LocalCluster(
                n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
            ) as cluster,
            distributed.Client(cluster) as client,
        ):
            dask.run(inputs, CASE, tmp_path / f"out{shards}", client, shards=shards)
            return 1e-3 * float(max(client.run(held).values()))

    few, many = most(library, 6), most(tmp_path / "five", 30)
    print(f"workers held {few:.0f} MB over 303 fabrics and {many:.0f} MB over 1515")
    assert many < FLAT * few


def test_finished_shards_are_not_done_again(library: Path, client: Any, tmp_path: Path) -> None:
    out = tmp_path / "out"
    copy = tmp_path / "library"
    shutil.copytree(library / "lot2", copy)
    assert not any(one.kept for one in dask.run(copy, CASE, out, client, shards=3))
    before = {path: path.stat().st_mtime_ns for path in out.glob("part-*.parquet")}
    assert all(one.kept for one in dask.run(copy, CASE, out, client, shards=3))
    assert before == {path: path.stat().st_mtime_ns for path in out.glob("part-*.parquet")}
    # A file that has changed belongs to one shard; a part that is broken is made again.
    changed = sorted(copy.rglob("results.csv"))[0]
    changed.write_bytes(changed.read_bytes() + b"\n")
    again = dask.run(copy, CASE, out, client, shards=3)
    assert sum(not one.kept for one in again) == 1
    whole = as_bytes(out)
    broken = out / again[0].shard.file
    broken.write_bytes(broken.read_bytes()[:100])
    with pytest.raises(kesf.KesfError, match="cannot be read") as refused:
        parts.merge(str(out))
    assert refused.value.code == "O067" and refused.value.path == str(broken)
    assert [one.kept for one in dask.run(copy, CASE, out, client, shards=3)] == [False, True, True]
    assert as_bytes(out) == whole
    # Another case is another run.
    assert not any(one.kept for one in dask.run(copy, "cases/virtual_shear.toml", out, client, shards=3))


def test_parts_that_do_not_belong_together_are_told(client: Any, tmp_path: Path) -> None:
    out = str(tmp_path / "out")
    with pytest.raises(kesf.KesfError, match="there is no part"):
        parts.merge(out)
    dask.run("kesf_data/petrak_m1", (), out, client, shards=3)
    with pytest.raises(kesf.KesfError, match="a run with 3 shards, and this one has 2"):
        dask.run("kesf_data/petrak_m1", (), out, client, shards=2)
    os.remove(tmp_path / "out" / "part-0002-of-0003.parquet")
    with pytest.raises(kesf.KesfError, match="1 of 3 parts are missing, number 2 first"):
        parts.merge(out)
    with pytest.raises(kesf.KesfError, match="no table of a part"):
        parts.merge(out, "numbers")
    with pytest.raises(kesf.KesfError, match="no shard 4 of 3"):
        parts.Shard(4, 3)


def test_one_name_in_two_parts_is_refused(tmp_path: Path) -> None:
    out = str(tmp_path)
    for number in (1, 2):
        parts.write(kesf.evaluate("kesf_data/petrak_m1"), out, parts.Shard(number, 2), "key")
    with pytest.raises(kesf.KesfError, match="petrak_m1 is in part-0001-of-0002") as refused:
        parts.merge(out)
    assert refused.value.code == "O068"


def test_what_cannot_be_opened_is_told(client: Any, tmp_path: Path) -> None:
    wrong: list[tuple[Any, str]] = [
        (tmp_path / "nowhere", "no such file"),
        ("gopher://fabrics", "cannot be opened"),
        (f"zip://*::{tmp_path}/nowhere.zip", "cannot be"),
    ]
    for inputs, what in wrong:
        with pytest.raises(kesf.KesfError, match=what) as refused:
            dask.run(inputs, (), tmp_path / "out", client)
        assert refused.value.code == "R001", refused.value
    (tmp_path / "empty").mkdir()
    with pytest.raises(kesf.KesfError, match="no measurement in the inputs"):
        dask.run(tmp_path / "empty", (), tmp_path / "out", client)
    with pytest.raises(kesf.KesfError, match="cannot be read"):
        dask.run("kesf_data", tmp_path / "case.toml", tmp_path / "out", client)
    with pytest.raises(kesf.KesfError, match="the settings cannot be used") as settings:
        (tmp_path / "settings.toml").write_text("bending_slop = 1\n")
        dask.run("kesf_data/petrak_m1", (), tmp_path / "out", client, settings=tmp_path / "settings.toml", retries=0)
    assert settings.value.code == "O050" and "1 of 1 shards failed" in settings.value.message


def test_a_fabric_that_cannot_be_described_is_told(client: Any, tmp_path: Path) -> None:
    library = tmp_path / "library"
    for name in ("good", "broken"):
        shutil.copytree(ROOT / "kesf_data" / "petrak_m1", library / name)
    (library / "broken" / "fabric.toml").write_text("title = \n")
    assert kesf.find(library)[str(library / "broken")] == [str(library / "broken" / "fabric.toml")]
    dask.run(library, CASE, tmp_path / "out", client, shards=2)
    whole = kesf.evaluate(library, CASE)
    told = parts.merge(str(tmp_path / "out"), "failures").to_pylist()
    assert [row["code"] for row in told] == ["R019"] == [row["code"] for row in whole.failures.rows()]
    assert {row["fabric"] for row in parts.merge(str(tmp_path / "out")).to_pylist()} == {"good"}


def test_paths_are_those_of_the_caller(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tasks = dask.plan("kesf_data/petrak_m1", CASE, "out")
    assert tasks[0].fabrics == (str(ROOT / "kesf_data" / "petrak_m1"),) and tasks[0].out == str(ROOT / "out")
    # A worker that does not see the folder says so: it does not take it for an empty one.
    gone = tmp_path / "petrak"
    shutil.copytree(ROOT / "kesf_data" / "petrak_m1", gone)
    (task,) = dask.plan(gone, CASE, tmp_path / "out")
    shutil.rmtree(gone)
    with pytest.raises(kesf.KesfError, match="no such file or folder on this worker") as refused:
        dask.work(task)
    assert refused.value.path == str(gone) and not parts.listed(str(tmp_path / "out"))


def test_a_full_disk_leaves_nothing_half_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (task,) = dask.plan("kesf_data/petrak_m1", CASE, tmp_path)
    synchronise = os.fsync

    def full(file: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(kesf.KesfError, match="No space left") as refused:
        dask.work(task)
    assert refused.value.code == "O001" and not [p for p in tmp_path.rglob("*") if p.is_file()]
    monkeypatch.setattr(os, "fsync", synchronise)
    # What a killed worker has left of this part goes, too.
    left = tmp_path / "_findings" / f".{task.shard.file}.0123.half"
    left.write_bytes(b"half")
    assert not dask.work(task).kept and dask.work(task).kept and not left.exists()


def test_a_zip_is_read_like_a_folder(library: Path, client: Any, tmp_path: Path) -> None:
    archive = shutil.make_archive(str(tmp_path / "fabrics"), "zip", library / "lot1")
    dask.run(f"zip://::{archive}", CASE, tmp_path / "zip", client, shards=2)
    dask.run(library / "lot1", CASE, tmp_path / "folder", client, shards=2)
    assert parts.merge(str(tmp_path / "zip")).equals(parts.merge(str(tmp_path / "folder")))


def test_a_store_of_objects_is_read_and_written(library: Path, client: Any, tmp_path: Path) -> None:
    pytest.importorskip("s3fs")
    server = pytest.importorskip("moto.server")
    store = server.ThreadedMotoServer(ip_address="127.0.0.1", port=0)
    store.start()
    try:
        host, port = store.get_host_and_port()
        options = {
            "key": "test",
            "secret": "test",
            "client_kwargs": {"endpoint_url": f"http://{host}:{port}", "region_name": "us-east-1"},
        }
        system, _ = parts.filesystem("s3://fabrics", options)
        system.call_s3("create_bucket", Bucket="fabrics")
        system.put(str(library / "lot1") + "/", "fabrics/lot1/", recursive=True)
        (tmp_path / "lot1").symlink_to(library / "lot1")
        done = dask.run("s3://fabrics/lot1", CASE, "s3://fabrics/out", client, shards=2, storage_options=options)
        assert sum(one.fabrics for one in done) == 101
        dask.run(library / "lot1", CASE, tmp_path / "out", client, shards=2)
        assert parts.merge("s3://fabrics/out", options=options).equals(parts.merge(str(tmp_path / "out")))
        kept = dask.run("s3://fabrics/lot1", CASE, "s3://fabrics/out", client, shards=2, storage_options=options)
        assert all(one.kept for one in kept)
    finally:
        store.stop()


def test_other_programs_read_the_parts(client: Any, tmp_path: Path) -> None:
    polars, duckdb = pytest.importorskip("polars"), pytest.importorskip("duckdb")
    dask.run("kesf_data", CASE, tmp_path, client, shards=3)
    whole = parts.merge(str(tmp_path))
    lazily = polars.scan_parquet(tmp_path / "part-*.parquet").filter(polars.col("quantity") == "B warp").collect()
    assert lazily.height == 13
    (count,) = duckdb.sql(f"select count(*) from '{tmp_path}/part-*.parquet'").fetchall()[0]
    assert count == whole.num_rows
    for path in tmp_path.glob("part-*.parquet"):
        file = parquet.ParquetFile(path)
        assert file.num_row_groups == 1
        assert file.schema_arrow.field("value").metadata == {b"unit_column": b"unit"}
