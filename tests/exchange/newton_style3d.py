"""A newton card, given to newton: the rigidities of the Style3D model that it builds on a grid along the yarns.

The model is not moved: the energy of a bent sheet is summed up from the arrays that newton keeps for its bending
kernel (`eval_bend_kernel`: 3/A k (c.x)(c.x)/2 for every hinge) and compared with the energy of a plate.
"""

import importlib.metadata
import json
import sys

import newton
import numpy as np
import problems
import warp as wp
from newton.solvers import style3d

CELLS, SIDE = 20, 0.04


def grid():
    """Points of the panel (x weft, y warp) and triangles whose diagonals change from column to column."""
    n, h = CELLS, SIDE / CELLS
    points = [(i * h, j * h, 0.0) for i in range(n + 1) for j in range(n + 1)]
    triangles = []
    for i in range(n):
        for j in range(n):
            a, b, c, d = (p * (n + 1) + q for p, q in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
            for triangle in ([a, b, c], [a, c, d]) if i % 2 == 0 else ([a, b, d], [b, c, d]):
                triangles += triangle
    return points, triangles


def model_of(card, points, triangles):
    builder = newton.ModelBuilder()
    newton.solvers.SolverStyle3D.register_custom_attributes(builder)
    style3d.add_cloth_mesh(
        builder,
        pos=wp.vec3(0.0, 0.0, 0.0),
        rot=wp.quat_identity(),
        vel=wp.vec3(0.0, 0.0, 0.0),
        vertices=[wp.vec3(*p) for p in points],
        indices=triangles,
        density=card["density"],
        tri_aniso_ke=wp.vec3(*card["tri_aniso_ke"]),
        edge_aniso_ke=wp.vec3(*card["edge_aniso_ke_grid"]),
        particle_radius=1e-4,
    )
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


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        card = json.load(file)
    points, triangles = grid()
    model = model_of(card, points, triangles)
    weft, warp, shear = (float(v) for v in model.style3d.tri_aniso_ke.numpy()[0])
    answers = {
        "tensile_warp": warp,
        "tensile_weft": weft,
        "shear": shear,
        "rigidity_warp": energy(model, points, lambda x, y: y * y / 2),
        "rigidity_weft": energy(model, points, lambda x, y: x * x / 2),
        "torsion": energy(model, points, lambda x, y: x * y) / 4,
        "mass": float(model.particle_mass.numpy().sum()) / SIDE**2,
    }
    version = "newton Style3D " + importlib.metadata.version("newton")
    problems.answer(version, {name: answers[name] for name in sys.argv[2:]})


if __name__ == "__main__":
    main()
