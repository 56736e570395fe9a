"""A CalculiX card, executed by `ccx`: S8R elements, NLGEOM where rotations are large."""

import re
import subprocess
import tempfile
from pathlib import Path

import problems


def grid(mesh):
    """Points of eight-node quads by their place in half cells."""
    (a, b), (n, m) = mesh.size, mesh.cells
    return {
        (i, j): (i * a / (2 * n), j * b / (2 * m))
        for j in range(2 * m + 1)
        for i in range(2 * n + 1)
        if not (i % 2 and j % 2)
    }


def supports(problem, fine):
    """What holds a mid-side point: what holds both of its neighbours on the side."""
    mesh, fixed = problem.mesh, problem.fixed
    for i, j in fine:
        low = fixed.get(mesh.at(i // 2, j // 2), ())
        high = fixed.get(mesh.at((i + 1) // 2, (j + 1) // 2), ())
        for dof in sorted(set(low) & set(high)):
            yield (i, j), dof


def edge_forces(problem):
    """Forces along the edges of a square, spread as eight-node elements spread a constant traction."""
    if not problem.forces:
        return
    n = problem.mesh.cells[0]
    share = problems.SHEAR_FORCE * problems.SHEAR_SIDE / n
    for k in range(n):
        for half, weight in ((2 * k, 1 / 6), (2 * k + 1, 4 / 6), (2 * k + 2, 1 / 6)):
            f = share * weight
            yield (half, 2 * n), 1, f
            yield (half, 0), 1, -f
            yield (2 * n, half), 2, f
            yield (0, half), 2, -f


def solve(path, problem):
    card = Path(path).read_text()
    elements = re.search(r"ELSET=([^,\s]+)", card).group(1)
    mesh, fine = problem.mesh, grid(problem.mesh)
    number = {place: k + 1 for k, place in enumerate(fine)}
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{number[p]}, {x:.9e}, {y:.9e}, 0." for p, (x, y) in fine.items()]
    lines.append(f"*ELEMENT, TYPE=S8R, ELSET={elements}")
    around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    (n, m), e = mesh.cells, 0
    for j in range(m):
        for i in range(n):
            e += 1
            nodes = [str(number[(2 * i + di, 2 * j + dj)]) for di, dj in around]
            lines.append(f"{e}, " + ", ".join(nodes))
    lines += [card.rstrip(), "*BOUNDARY"]
    lines += [f"{number[p]}, {dof}, {dof}" for p, dof in supports(problem, fine)]
    increment = 1.0 / problem.steps
    lines.append("*STEP, NLGEOM, INC=1000" if problem.nonlinear else "*STEP")
    lines.append(f"*STATIC\n{increment}, 1., 1e-8, {increment}" if problem.nonlinear else "*STATIC")
    size = sum(a * a for a in problem.acceleration) ** 0.5
    if size > 0.0:
        direction = ", ".join(f"{a / size:.1f}" for a in problem.acceleration)
        lines.append(f"*DLOAD\n{elements}, GRAV, {size:.9e}, {direction}")
    forces = list(edge_forces(problem))
    if forces:
        lines.append("*CLOAD")
        lines += [f"{number[p]}, {dof}, {f:.9e}" for p, dof, f in forces]
    lines += ["*NODE PRINT, NSET=NALL, FREQUENCY=1000", "U", "*END STEP", ""]
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "model.inp").write_text("\n".join(lines))
        ran = subprocess.run(["ccx", "model"], cwd=folder, capture_output=True, text=True, check=False)
        data = Path(folder) / "model.dat"
        rows = [r.split() for r in data.read_text().splitlines()] if data.exists() else []
    # The last block of displacements is that of the whole load.
    moved = {int(r[0]): [float(v) for v in r[1:4]] for r in rows if len(r) == 4 and r[0].isdigit()}
    if "*ERROR" in ran.stdout or len(moved) != len(fine):
        raise SystemExit("CalculiX failed:\n" + ran.stdout[-2000:])
    corners = {mesh.at(i // 2, j // 2): number[(i, j)] for i, j in fine if not (i % 2 or j % 2)}
    return [moved[corners[k]] for k in range(len(mesh.points))]


if __name__ == "__main__":
    told = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
    found = re.search(r"[Vv]ersion\s+(\S+)", told)
    problems.main("CalculiX " + (found.group(1) if found else "(version unknown)"), solve)
