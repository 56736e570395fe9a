"""A newton card, given to newton: the rigidities of the Style3D model that it builds, and a strip that it moves.

`rigidity_*`, `torsion`: the energy of a bent sheet is summed up from the arrays that newton keeps for its bending
kernel (`eval_bend_kernel`: 3/A k (c.x)(c.x)/2 for every hinge) and compared with the energy of a plate.

`strip_*`: SolverStyle3D moves a strip from flat until it rests under its own weight. Its iterations have one fixed
matrix, in which the tensile stiffness resists deflection, too: a strip as stiff in tension as cloth moves by a
millionth of its way an iteration. So the strip has a `SOFTER`th of the tensile and shear stiffness of the card, which
lengthens it by less than 0.2 % (w L/2E); mass and bending, which decide the drop, are those of the card.
"""

import importlib.metadata
import json
import math
import sys

import newton
import numpy as np
import problems
import warp as wp
from newton.solvers import style3d

CELLS, SIDE = 20, 0.04
# The strip: stiffness, time step (s), iterations of a step and of its linear system, most steps.
SOFTER, STEP, ITERATIONS, LINEAR, STEPS = 200.0, 1.0 / 930.0, 10, 10, 1200
# It rests when its speed, brought to zero at each peak of its kinetic energy, peaked so often within this part.
PEAKS, PART = 4, 1e-4


def grid(h=SIDE / CELLS, start=(0.0, 0.0)):
    """Points of the panel (x weft, y warp) and triangles whose diagonals change from column to column."""
    n = CELLS
    points = [(start[0] + i * h, start[1] + j * h, 0.0) for i in range(n + 1) for j in range(n + 1)]
    triangles = []
    for i in range(n):
        for j in range(n):
            a, b, c, d = (p * (n + 1) + q for p, q in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
            for triangle in ([a, b, c], [a, c, d]) if i % 2 == 0 else ([a, b, d], [b, c, d]):
                triangles += triangle
    return points, triangles


def model_of(card, points, triangles, softer=1.0, held=()):
    builder = newton.ModelBuilder(up_axis=newton.Axis.Z, gravity=(0.0, 0.0, -problems.G))
    newton.solvers.SolverStyle3D.register_custom_attributes(builder)
    style3d.add_cloth_mesh(
        builder,
        pos=wp.vec3(0.0, 0.0, 0.0),
        rot=wp.quat_identity(),
        vel=wp.vec3(0.0, 0.0, 0.0),
        vertices=[wp.vec3(*p) for p in points],
        indices=triangles,
        density=card["density"],
        tri_aniso_ke=wp.vec3(*(k / softer for k in card["tri_aniso_ke"])),
        edge_aniso_ke=wp.vec3(*card["edge_aniso_ke_grid"]),
        particle_radius=1e-4,
    )
    for point in held:
        builder.particle_flags[point] &= ~int(newton.ParticleFlags.ACTIVE)
    return builder.finalize(device="cpu")


def energy(model, points, height):
    """Energy of the hinges over the area of those that lie well inside, twice, of a sheet bent to `height(x, y)`."""
    edges = model.edge_indices.numpy()
    area = model.style3d.edge_rest_area.numpy()
    cot = model.style3d.edge_bending_cot.numpy()
    stiffness = model.edge_bending_properties.numpy()[:, 0]
    xy = np.array(points)[:, :2]
    z = height(xy[:, 0] - SIDE / 2, xy[:, 1] - SIDE / 2)
    h = SIDE / CELLS
    low, high = 4 * h - 1e-9, SIDE - 4 * h - 1e-9
    total = 0.0
    for (o0, o1, v0, v1), a, c, k in zip(edges, area, cot, stiffness):
        middle = (xy[v0] + xy[v1]) / 2
        if o0 < 0 or o1 < 0 or not ((middle >= low).all() and (middle < high).all()):
            continue
        weights = [-c[0] - c[2], -c[1] - c[3], c[2] + c[3], c[0] + c[1]]
        bend = sum(w * z[p] for w, p in zip(weights, (o0, o1, v0, v1)))
        total += k * 3.0 / a * bend * bend
    return total / (SIDE - 8 * h) ** 2


def drop(card, along):
    """Drop of the tip over its length, of a square piece held at y = 0 (the warp hangs over) or x = 0 (the weft)."""
    axis = 1 if along == "warp" else 0
    # The clamp is the middle of the first column of squares, both sides of which are held.
    h = problems.STRIP / (CELLS - 0.5)
    points, triangles = grid(h, tuple(-h / 2 if axis == i else 0.0 for i in (0, 1)))
    place = np.array(points)[:, axis]
    model = model_of(card, points, triangles, SOFTER, np.where(place < 0.6 * h)[0])
    return rest(model, place > problems.STRIP - 0.5 * h)


def rest(model, tip):
    """Drop of some points over the length of the strip when it rests; not a number if it does not."""
    config = newton.solvers.SolverStyle3D.Config(iterations=ITERATIONS, linear_iterations=LINEAR)
    solver = newton.solvers.SolverStyle3D(model, config=config)
    solver.collision = None
    before, after, control = model.state(), model.state(), model.control()
    mass = model.particle_mass.numpy()
    last, peaks = 0.0, []
    for step in range(STEPS):
        solver.step(before, after, control, None, STEP)
        before, after = after, before
        if step % 2 == 0:
            continue
        kinetic = float((mass[:, None] * before.particle_qd.numpy() ** 2).sum())
        if kinetic < last:
            before.particle_qd.zero_()
            kinetic = 0.0
            peaks.append(float(-before.particle_q.numpy()[tip, 2].mean()) / problems.STRIP)
            recent = peaks[-PEAKS:]
            if len(recent) == PEAKS and max(recent) - min(recent) < PART * recent[-1]:
                return recent[-1]
        last = kinetic
    return math.nan


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        card = json.load(file)
    points, triangles = grid()
    model = model_of(card, points, triangles)
    weft, warp, shear = (float(v) for v in model.style3d.tri_aniso_ke.numpy()[0])
    answers = {
        "tensile_warp": lambda: warp,
        "tensile_weft": lambda: weft,
        "shear": lambda: shear,
        "rigidity_warp": lambda: energy(model, points, lambda x, y: y * y / 2),
        "rigidity_weft": lambda: energy(model, points, lambda x, y: x * x / 2),
        "torsion": lambda: energy(model, points, lambda x, y: x * y) / 4,
        "mass": lambda: float(model.particle_mass.numpy().sum()) / SIDE**2,
        "strip_warp": lambda: drop(card, "warp"),
        "strip_weft": lambda: drop(card, "weft"),
    }
    version = "newton Style3D " + importlib.metadata.version("newton")
    problems.answer(version, {name: answers[name]() for name in sys.argv[2:]})


if __name__ == "__main__":
    main()
