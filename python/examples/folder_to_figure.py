"""A laboratory's folder to a paper's figure: what was measured, what it means, and what a simulated test makes of it.

python folder_to_figure.py kesf_data/poplin cases/virtual_bending.toml figure.pdf
"""

import sys

import numpy as np
from matplotlib.figure import Figure

import kesf


def main(folder: str, case: str, out: str) -> kesf.Comparison:
    fabric = kesf.read(folder)[0]
    for finding in fabric.findings:
        print(finding)
    sheet = kesf.characterise(fabric)
    for direction in ("warp", "weft"):
        print(f"B {direction}: {sheet['B', direction]}")

    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    measured, simulated = figure.subplots(1, 2)
    sheet.plot("bending", axes=measured)

    # The section is made of the measured rigidity: the simulated test sees it through clamps and free edges.
    comparison = kesf.compare(case, sheet)
    for curve, colour in zip(comparison.curves, ("#0072b2", "#d55e00"), strict=True):
        order = np.argsort(curve.x)
        simulated.plot(curve.x / 100.0, curve.measured / 9.80665e-3, color=colour, alpha=0.35)
        simulated.plot(curve.x[order] / 100.0, curve.simulated[order] / 9.80665e-3, color=colour, label=curve.name)
        print(f"{curve.name}: R² {curve.r2:.3f}, RMSE {curve.rmse:.3g} {curve.unit}")
    simulated.set_xlabel("Curvature (1/cm)")
    simulated.set_title("Simulated (dark) on measured (pale)")
    simulated.legend(frameon=False)
    figure.savefig(out)
    return comparison


if __name__ == "__main__":
    main(*sys.argv[1:])
