"""A USD card, read by newton: what arrives in its model, and a strip that hangs.

`rigidity_*`, `as_read_*`: the energy of a bent strip is summed up from what newton keeps for the hinges of its VBD solver
(`evaluate_dihedral_angle_based_bending_force_hessian`: stiffness, length of the hinge, angle squared over two) and
compared with the energy of a plate. newton takes `surfaceBendStiffness` as it is, so that a bent sheet has that number
times the distance between hinges for a rigidity: `rigidity_*` takes the distance out again, as the card advises, and
`as_read_*` leaves it in.

`strip_*`: the mesh, the held points and the stiffnesses of the stage are given to SolverStyle3D by the relation of the
`newton` card (`newton_style3d.py`), and the strip rests under its own weight. Each hinge has a third of
`surfaceBendStiffness`, whatever its direction; this is the one conversion between the stage and the solver.

`as_read_strip_*`: newton's reader and its VBD solver, nothing between them but the held points: where the tip is a second after
the strip was let go, without swinging.
"""

import importlib.metadata
import sys
import warnings

import newton
import newton_style3d
import numpy as np
import problems
from pxr import Usd

warnings.simplefilter("ignore")


BODIES = {"warp": "strip_warp", "weft": "strip_weft", "mean": "sheet"}
# VBD as newton's examples of cloth use it: ten steps of ten sweeps a frame of a sixtieth of a second.
FRAMES, SUBSTEPS, SWEEPS = 60, 10, 10


def read(path, yarn):
    """newton's builder with one body of the stage, and the mesh of that body."""
    stage = Usd.Stage.Open(path)
    builder = newton.ModelBuilder()
    builder.add_usd(path, ignore_paths=[f"/World/{body}.*" for key, body in BODIES.items() if key != yarn])
    return builder, stage.GetPrimAtPath(f"/World/{BODIES[yarn]}/sim"), stage


def strip(path, yarn):
    along = 1 if yarn == "weft" else 0
    builder, mesh, _ = read(path, yarn)
    points = np.array([list(q) for q in builder.particle_q])
    assert len(points) == len(mesh.GetAttribute("points").Get())
    thickness = mesh.GetAttribute("physics:thicknesses").Get()[0]
    rows = np.unique(np.round(points[:, along], 7))
    between = rows[1] - rows[0]
    stretch = {m[0] for m in builder.tri_materials}
    bend = {e[0] for e in builder.edge_bending_properties}
    assert len(stretch) == 1 and len(bend) == 1, (stretch, bend)
    # A bend of 1/m across the strip turns each straight hinge by the distance between hinges.
    (stiffness,), energy, area = bend, 0.0, 0.0
    for (o0, o1, v0, v1), length in zip(builder.edge_indices, builder.edge_rest_length):
        across = abs(points[v0][along] - points[v1][along]) < 1e-7
        if across and o0 >= 0 and o1 >= 0:
            energy += stiffness * length * between**2
            area += length * between
    size = np.ptp(points[:, 0]) * np.ptp(points[:, 1])
    return {
        f"tensile_{yarn}": stretch.pop(),
        f"rigidity_{yarn}": energy / area / between,
        f"as_read_{yarn}": energy / area,
        "mass": sum(builder.particle_mass) / size,
        "thickness": float(thickness),
    }


def drop(path, yarn):
    """Drop of the tip over the length of the strip, moved by SolverStyle3D."""
    builder, mesh, stage = read(path, yarn)
    material = stage.GetPrimAtPath(f"/World/Materials/{yarn}")
    stretch, shear, bend, density = (
        material.GetAttribute(f"physics:{name}").Get()
        for name in ("surfaceStretchStiffness", "surfaceShearStiffness", "surfaceBendStiffness", "density")
    )
    # A hinge along 45 degrees has a 64th of both others besides its own.
    hinge = bend / 3.0
    card = {
        "density": density * mesh.GetAttribute("physics:thicknesses").Get()[0],
        "tri_aniso_ke": [stretch, stretch, shear],
        "edge_aniso_ke_grid": [hinge, hinge, hinge * (1.0 - 2.0 / 64.0)],
    }
    points = [tuple(map(float, p)) for p in mesh.GetAttribute("points").Get()]
    triangles = [int(i) for i in mesh.GetAttribute("faceVertexIndices").Get()]
    held = [int(i) for i in mesh.GetAttribute("kesf:held").Get()]
    model = newton_style3d.model_of(card, points, triangles, newton_style3d.SOFTER, held)
    return newton_style3d.rest(model, tip(points, yarn))


def tip(points, yarn):
    place = np.array(points)[:, 1 if yarn == "weft" else 0]
    return place > place.max() - 1e-6


def as_read(path, yarn):
    """The same by newton's own reader and VBD."""
    builder, mesh, _ = read(path, yarn)
    for point in mesh.GetAttribute("kesf:held").Get():
        builder.particle_flags[point] &= ~int(newton.ParticleFlags.ACTIVE)
    end = tip([list(q) for q in builder.particle_q], yarn)
    builder.color(include_bending=True)
    model = builder.finalize(device="cpu")
    solver = newton.solvers.SolverVBD(model, iterations=SWEEPS, particle_enable_self_contact=False)
    before, after, control = model.state(), model.state(), model.control()
    mass, last = model.particle_mass.numpy(), 0.0
    for _ in range(FRAMES * SUBSTEPS):
        solver.step(before, after, control, None, 1.0 / (60 * SUBSTEPS))
        before, after = after, before
        kinetic = float((mass[:, None] * before.particle_qd.numpy() ** 2).sum())
        if kinetic < last:
            before.particle_qd.zero_()
            kinetic = 0.0
        last = kinetic
    return float(-before.particle_q.numpy()[end, 2].mean()) / problems.STRIP


def main():
    path, names, answers = sys.argv[1], sys.argv[2:], {}
    for yarn in ("warp", "weft"):
        answers.update(strip(path, yarn))
        for name, of in ((f"strip_{yarn}", drop), (f"as_read_strip_{yarn}", as_read)):
            if name in names:
                answers[name] = of(path, yarn)
    if any(name.startswith("mean_") for name in names):
        sheet = strip(path, "mean")
        answers.update({f"mean_{what}": sheet[f"{what}_mean"] for what in ("tensile", "rigidity")})
    stage = Usd.Stage.Open(path)
    answers["shear"] = stage.GetPrimAtPath("/World/Materials/sheet").GetAttribute("physics:surfaceShearStiffness").Get()
    version = "newton USD " + importlib.metadata.version("newton")
    problems.answer(version, {name: float(answers[name]) for name in names})


if __name__ == "__main__":
    main()
