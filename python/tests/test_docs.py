"""Documentation runs: the docstrings of the package, and the blocks of the book's page about Python in their order."""

from __future__ import annotations

import doctest
import importlib
import pkgutil
import re
from pathlib import Path
from typing import Any

import pytest

import kesf

ROOT = Path(__file__).resolve().parents[2]

#: Every module of the package that is written in Python.
MODULES = [f"kesf.{m.name}" for m in pkgutil.iter_modules(kesf.__path__) if m.name != "_kesf"]


@pytest.mark.parametrize("name", ["kesf", *MODULES])
def test_examples_in_docstrings_hold(name: str) -> None:
    result = doctest.testmod(importlib.import_module(name))
    assert result.failed == 0


def test_there_are_examples_in_docstrings() -> None:
    finder = doctest.DocTestFinder()
    counted = {name: len(finder.find(importlib.import_module(name))) for name in MODULES}
    assert sum(counted.values()) > 20
    for name in ("read", "characterise", "section", "solve", "compare", "run", "verify", "export", "evaluate", "find"):
        assert ">>>" in (getattr(kesf, name).__doc__ or ""), name


def blocks(page: str, kind: str = "python") -> list[str]:
    text = (ROOT / "docs" / "src" / page).read_text(encoding="utf-8")
    return re.findall(rf"^```{kind}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


@pytest.fixture()
def clone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder like the clone, where results may be written."""
    for name in ("kesf_data", "cases"):
        (tmp_path / name).symlink_to(ROOT / name, target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def ran(page: str, kind: str = "python") -> dict[str, Any]:
    names: dict[str, Any] = {"__name__": "__main__", "ROOT": str(ROOT)}
    for block in blocks(page, kind):
        exec(compile(block, page, "exec"), names)
    return names


def test_the_page_about_python_runs(clone: Path) -> None:
    for module in ("tqdm", "polars", "pyarrow", "duckdb", "pandas", "daft"):
        pytest.importorskip(module)
    assert len(blocks("python.md")) >= 6
    names = ran("python.md")
    assert (clone / "results" / "index.html").exists()
    assert names["suite"].passed and names["field"].metadata == {b"unit": "N·m".encode()}


def test_the_page_about_clusters_runs(clone: Path) -> None:
    for module in ("distributed", "fsspec", "polars", "pyarrow", "tqdm"):
        pytest.importorskip(module)
    names = ran("cluster.md")
    assert names["table"].num_rows == len(kesf.evaluate("kesf_data", "cases/virtual_bending.toml"))
    assert (clone / "library.parquet").exists()


@pytest.mark.parametrize("engine", ["ray", "daft"])
def test_other_engines_evaluate(clone: Path, engine: str) -> None:
    pytest.importorskip("pyarrow")
    pytest.importorskip(engine)
    table = ran("cluster.md", f"python,{engine}")["table"]
    cases = "cases/virtual_bending.toml" if engine == "ray" else ()
    whole = kesf.evaluate("kesf_data", cases).results.rows()
    kept = ("fabric", "quantity", "value", "unit")
    found = sorted(str([row[name] for name in kept]) for row in table.to_pylist())
    assert found == sorted(str([row[name] for name in kept]) for row in whole)
