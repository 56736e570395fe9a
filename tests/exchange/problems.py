"""The problems that every program is given: meshes, supports and loads, free of any program.

`x` is the warp and `y` the weft. Every problem returns one number, which the test compares with a closed form
or a series that shares no code with this folder. SI throughout.

strip_warp, strip_weft  a strip held at one end bends under its own weight   drop of the tip over its length
hang_warp, hang_weft    a strip hangs along its yarns in 1000 g, linear      elongation over its length
shear                   a square under shear forces along its edges, linear  shear angle times G over force per length: G
plate                   a rectangle supported on all edges, linear           deflection of its centre
sheet                   a square clamped all round under its own weight      deflection of its centre

mesh_strip_*, mean_* and others are problems of one program alone, in its own script.
"""

import json
import math
import sys

G = 9.80665
STRIP, WIDTH = 0.04, 0.02
PLATE = (0.3, 0.2)
PLATE_GRAVITY = 1e-6 * G
SHEET = 0.2
HANG_GRAVITY = 1e3 * G
SHEAR_SIDE, SHEAR_FORCE = 0.1, 1e-3

ALL = (1, 2, 3, 4, 5, 6)


class Mesh:
    """A grid of quads in the plane `z = 0`; every quad begins at its corner of least x and y and turns left."""

    def __init__(self, size, cells, middles=False):
        self.size, self.cells = size, cells
        (a, b), (n, m) = size, cells
        self.points = [(i * a / n, j * b / m) for j in range(m + 1) for i in range(n + 1)]
        self.quads = [
            (self.at(i, j), self.at(i + 1, j), self.at(i + 1, j + 1), self.at(i, j + 1))
            for j in range(m)
            for i in range(n)
        ]

    def at(self, i, j):
        """The index of a point of the grid, from 0."""
        return j * (self.cells[0] + 1) + i

    def where(self, condition):
        """Indices of the points for which a condition of x and y holds."""
        return [k for k, (x, y) in enumerate(self.points) if condition(x, y)]


class Problem:
    """What a program solves: degrees of freedom are 1 to 3 for displacements, 4 to 6 for rotations."""

    def __init__(self, mesh, acceleration, nonlinear, steps=1, power=1):
        self.mesh, self.acceleration, self.nonlinear, self.steps = mesh, acceleration, nonlinear, steps
        self.power = power
        self.fixed, self.forces = {}, {}

    def shares(self):
        """The part of the load after each step."""
        return [(step / self.steps) ** self.power for step in range(1, self.steps + 1)]

    def fix(self, points, dofs):
        for k in points:
            self.fixed[k] = tuple(sorted(set(self.fixed.get(k, ())) | set(dofs)))

    def force(self, point, vector):
        old = self.forces.get(point, (0.0, 0.0, 0.0))
        self.forces[point] = tuple(a + b for a, b in zip(old, vector))


def strip(along, cells=(32, 4), steps=10):
    size, cells = ((STRIP, WIDTH), cells) if along == 0 else ((WIDTH, STRIP), cells[::-1])
    problem = Problem(Mesh(size, cells), (0.0, 0.0, -G), True, steps)
    problem.fix(problem.mesh.where(lambda *p: p[along] < 1e-12), ALL)
    tip = problem.mesh.at(*((cells[0], cells[1] // 2) if along == 0 else (cells[0] // 2, cells[1])))
    return problem, lambda u: -u[tip][2] / STRIP


def hang(along, cells=(32, 4)):
    # So narrow that the straight clamp, which a hanging strip would curve, does not matter.
    size, cells = ((STRIP, WIDTH / 4), cells) if along == 0 else ((WIDTH / 4, STRIP), cells[::-1])
    pull = (HANG_GRAVITY, 0.0, 0.0) if along == 0 else (0.0, HANG_GRAVITY, 0.0)
    problem = Problem(Mesh(size, cells), pull, False)
    mesh = problem.mesh
    problem.fix(range(len(mesh.points)), (3, 4, 5))
    end = mesh.where(lambda *p: p[along] < 1e-12)
    # A grip that holds a straight edge lets no point of it turn in the plane.
    problem.fix(end, (along + 1, 6))
    problem.fix(end[len(end) // 2 : len(end) // 2 + 1], (2 - along,))
    tip = mesh.at(*((cells[0], cells[1] // 2) if along == 0 else (cells[0] // 2, cells[1])))
    return problem, lambda u: u[tip][along] / STRIP


def shear(cells=8):
    problem = Problem(Mesh((SHEAR_SIDE, SHEAR_SIDE), (cells, cells)), (0.0, 0.0, 0.0), False)
    mesh = problem.mesh
    problem.fix(range(len(mesh.points)), (3, 4, 5))
    problem.fix([mesh.at(0, 0)], (1, 2))
    problem.fix([mesh.at(cells, 0)], (2,))
    share = SHEAR_FORCE * SHEAR_SIDE / cells
    for k in range(cells + 1):
        f = share * (0.5 if k in (0, cells) else 1.0)
        problem.force(mesh.at(k, cells), (f, 0.0, 0.0))
        problem.force(mesh.at(k, 0), (-f, 0.0, 0.0))
        problem.force(mesh.at(cells, k), (0.0, f, 0.0))
        problem.force(mesh.at(0, k), (0.0, -f, 0.0))
    corner = mesh.at(0, cells)
    return problem, lambda u: SHEAR_FORCE * SHEAR_SIDE / u[corner][0]


def plate(cells=(36, 24)):
    problem = Problem(Mesh(PLATE, cells), (0.0, 0.0, -PLATE_GRAVITY), False)
    mesh, (a, b) = problem.mesh, PLATE
    problem.fix(range(len(mesh.points)), (1, 2, 6))
    # Hard supports: no rotation about the normal of the edge.
    problem.fix(mesh.where(lambda x, y: x < 1e-12 or x > a - 1e-12), (3, 4))
    problem.fix(mesh.where(lambda x, y: y < 1e-12 or y > b - 1e-12), (3, 5))
    centre = mesh.at(cells[0] // 2, cells[1] // 2)
    return problem, lambda u: -u[centre][2]


def sheet(cells=16, steps=20):
    # A quarter: the sides x = 0 and y = 0 are the middle lines.
    half = SHEET / 2
    # Held all round, it carries as the cube of its deflection: steps of the same load would begin far too large.
    problem = Problem(Mesh((half, half), (cells, cells)), (0.0, 0.0, -G), True, steps, power=3)
    mesh, edge = problem.mesh, half - 1e-12
    problem.fix(mesh.where(lambda x, y: x > edge or y > edge), ALL)
    problem.fix(mesh.where(lambda x, y: x < 1e-12), (1, 5, 6))
    problem.fix(mesh.where(lambda x, y: y < 1e-12), (2, 4, 6))
    return problem, lambda u: -u[mesh.at(0, 0)][2]


PROBLEMS = {
    "strip_warp": lambda: strip(0),
    "strip_weft": lambda: strip(1),
    "hang_warp": lambda: hang(0),
    "hang_weft": lambda: hang(1),
    "shear": shear,
    "plate": plate,
    "sheet": sheet,
}


def main(version, solve, more=None):
    """`python PROGRAM.py CARD PROBLEM...`: prints one JSON document with the version and a number for each problem.

    `solve(card, problem)` returns the displacement (at least three numbers) of every point of the mesh; `more` has the
    answers to problems of the program's own.
    """
    card, names = sys.argv[1], sys.argv[2:]
    answers = dict(more or {})
    for name in names:
        if name in answers:
            continue
        problem, read = PROBLEMS[name]()
        value = read(solve(card, problem))
        answers[name] = value if math.isfinite(value) else None
    answer(version, answers)


def answer(version, answers):
    # Programs print to standard output as they please: the answer is the last line.
    print("\n" + json.dumps({"version": version, "answers": answers}))
