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


def test_the_blocks_of_the_page_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("tqdm", "polars", "pyarrow", "duckdb", "pandas"):
        pytest.importorskip(module)
    for name in ("kesf_data", "cases"):
        (tmp_path / name).symlink_to(ROOT / name, target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "docs" / "src" / "python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    assert len(blocks) >= 6
    names: dict[str, Any] = {}
    for block in blocks:
        exec(compile(block, "python.md", "exec"), names)
    assert (tmp_path / "results" / "index.html").exists()
    assert names["suite"].passed and names["field"].metadata == {b"unit": "N·m".encode()}
