"""Fabrics a second and core through the package, beside the command: ``python tests/speed.py COMMAND [FABRICS]``.

Both read copies of a shipped fabric of 21 records (seven files of three specimens each), evaluate them and solve a
virtual bending test and a clamped square of 40 x 40 elements, on one thread, in turns. What counts is the processor
time of the best of five turns, which other work on the machine changes least; that of starting Python is left out,
that of the command is in.
"""

from __future__ import annotations

import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import kesf

ROOT = Path(__file__).resolve().parents[2]
CASES = ["virtual_bending.toml", "seed_clamped.toml"]
TURNS = 5


def library(root: Path, fabrics: int) -> Path:
    """So many copies of twill under names of their own."""
    for number in range(fabrics):
        shutil.copytree(ROOT / "kesf_data" / "twill", root / "fabrics" / f"twill_{number:04d}")
    return root / "fabrics"


def of_children() -> float:
    """Processor time of the programs that were started (s)."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def seconds(clock: Callable[[], float], work: Callable[[], object]) -> float:
    """What work takes by a clock."""
    before = clock()
    work()
    return clock() - before


def main(command: str, fabrics: int) -> None:
    cases = [str(ROOT / "cases" / name) for name in CASES]
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        lab = str(library(root, fabrics))

        def by_command() -> None:
            out = root / "command"
            arguments = [command, "-q", "-j", "1", "run", lab, *cases, "--no-charts", "-o", str(out)]
            subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            shutil.rmtree(out)

        def by_package() -> None:
            out = root / "package"
            kesf.run(lab, cases, out=out, charts=False, threads=1)
            shutil.rmtree(out)

        ways: list[tuple[str, Callable[[], float], Callable[[], object]]] = [
            ("kesf run", of_children, by_command),
            ("kesf.run", time.process_time, by_package),
            ("kesf.evaluate", time.process_time, lambda: kesf.evaluate(lab, cases, threads=1)),
        ]
        turns = [[seconds(clock, work) for _, clock, work in ways] for _ in range(TURNS)]
    best = [min(turn[way] for turn in turns) for way in range(len(ways))]
    for (name, _, _), took in zip(ways, best, strict=True):
        each, speed = f"{1e3 * took / fabrics:6.1f} ms a fabric", f"{fabrics / took:5.1f} fabrics a second and core"
        print(f"{name:14} {each}, {speed}, {100.0 * best[0] / took:.0f} % of the command")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 40)
