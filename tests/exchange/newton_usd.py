"""A USD card, read by newton: what arrives in its model.

The model is not moved: the energy of a bent strip is summed up from what newton keeps for the hinges of its VBD solver
(`evaluate_dihedral_angle_based_bending_force_hessian`: stiffness, length of the hinge, angle squared over two) and
compared with the energy of a plate. newton takes `surfaceBendStiffness` as it is, so that a bent sheet has that number
times the distance between hinges for a rigidity: `rigidity_*` takes the distance out again, as the card advises, and
`as_read_*` leaves it in.
"""

import importlib.metadata
import sys
import warnings

import newton
import numpy as np
import problems
from pxr import Usd

warnings.simplefilter("ignore")


def strip(path, yarn):
    bodies = {"warp": "strip_warp", "weft": "strip_weft", "mean": "sheet"}
    along = 1 if yarn == "weft" else 0
    stage = Usd.Stage.Open(path)
    mesh = stage.GetPrimAtPath(f"/World/{bodies[yarn]}/sim")
    builder = newton.ModelBuilder()
    builder.add_usd(path, ignore_paths=[f"/World/{body}.*" for key, body in bodies.items() if key != yarn])
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


def main():
    path, answers = sys.argv[1], {}
    for yarn in ("warp", "weft"):
        answers.update(strip(path, yarn))
    if any(name.startswith("mean_") for name in sys.argv[2:]):
        sheet = strip(path, "mean")
        answers.update({f"mean_{what}": sheet[f"{what}_mean"] for what in ("tensile", "rigidity")})
    stage = Usd.Stage.Open(path)
    answers["shear"] = stage.GetPrimAtPath("/World/Materials/sheet").GetAttribute("physics:surfaceShearStiffness").Get()
    version = "newton USD " + importlib.metadata.version("newton")
    problems.answer(version, {name: float(answers[name]) for name in sys.argv[2:]})


if __name__ == "__main__":
    main()
