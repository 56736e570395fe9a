"""How much a prediction hangs on what no KES test measures: the torsional rigidity D66.

The same square of cloth is clamped at one side and hangs under its own weight; D66 is anything from nothing to twice
what Huber's estimate says. Bending alone does not twist the sheet, so its deflection at the middle of the free edge
should hardly move, while a load at one corner should feel it.

    python torsion_study.py kesf_data/poplin study.csv
"""

import csv
import sys
from typing import Any

import numpy as np

import kesf

SQUARE: dict[str, Any] = {
    "title": "Cloth clamped at one side",
    "source": "study of D66",
    "fabric": "*",
    "sheet": {"shape": "rectangle", "width": "4 cm", "height": "4 cm", "cells": [20, 20]},
    "supports": [{"set": "left", "kind": "clamped"}],
    "probes": [
        {"name": "middle", "at": ["4 cm", "2 cm"]},
        {"name": "corner", "at": ["4 cm", "4 cm"]},
    ],
}

LOADS: dict[str, dict[str, Any]] = {
    "weight": {"kind": "pressure", "value": "0.01 Pa"},
    "corner": {"kind": "point", "at": ["4 cm", "4 cm"], "value": "1e-6 N", "direction": [0, 0, 1]},
}


def main(folder: str, out: str) -> list[dict[str, float | str]]:
    sheet = kesf.characterise(folder)
    huber = float(kesf.section(sheet, torsion="huber").d_b[2, 2])
    rows: list[dict[str, float | str]] = []
    for share in np.linspace(0.25, 2.0, 8):
        section = kesf.section(sheet, torsion=f"{float(share) * huber} N·m")
        for load, table in LOADS.items():
            solution = kesf.solve({**SQUARE, "loads": [table]}, section)
            corner, middle = solution.probes["corner"].w, solution.probes["middle"].w
            rows.append({"load": load, "d66_over_huber": float(share), "middle": middle, "corner": corner})
    with open(out, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    for load in LOADS:
        at = [float(row["corner"]) for row in rows if row["load"] == load]
        print(f"{load}: the corner moves by {100.0 * (max(at) / min(at) - 1.0):.1f} % over the range of D66")
    return rows


if __name__ == "__main__":
    main(*sys.argv[1:])
