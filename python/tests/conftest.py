"""Where the shipped data are."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import kesf

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def in_the_root(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tests and doctests name the shipped data as they stand in the root of the clone."""
    monkeypatch.chdir(ROOT)


@pytest.fixture(scope="session")
def sheets() -> kesf.Sheets:
    """All shipped fabrics."""
    before = os.getcwd()
    os.chdir(ROOT)
    try:
        return kesf.characterise(kesf.read("kesf_data"))
    finally:
        os.chdir(before)


@pytest.fixture()
def poplin(sheets: kesf.Sheets) -> kesf.Sheet:
    """A fabric with curves and repeats."""
    return sheets["poplin"]
