"""A drape that kesf solved, as a USD stage: what arrives in newton's model of it, and in USD's own library.

The coefficient is that of a shadow of the points in newton: the farthest edge of any triangle on each of 3600 rays from the
axis, less the disc. The case leaves the disc out of what it solves; here it is held.
"""

import json
import sys
import warnings

import newton
import numpy as np
from pxr import Usd, UsdGeom

warnings.simplefilter("ignore")
RAYS = 3600


def areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def farthest(points, triangles):
    """The farthest place of the shadow on each ray."""
    edges = np.unique(np.sort(np.vstack([triangles[:, [i, j]] for i, j in ((0, 1), (1, 2), (2, 0))]), axis=1), axis=0)
    p, q = points[edges[:, 0], :2], points[edges[:, 1], :2]
    far = np.zeros(RAYS)
    for k, angle in enumerate(2 * np.pi * (np.arange(RAYS) + 0.5) / RAYS):
        along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        u, v = p @ across, q @ across
        cuts = (u * v < 0) & ((p + q) @ along > 0)
        s = u[cuts] / (u[cuts] - v[cuts])
        far[k] = ((1 - s) * (p[cuts] @ along) + s * (q[cuts] @ along)).max()
    return far


def main():
    path = sys.argv[1]
    stage = Usd.Stage.Open(path)
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdGeom.GetStageUpAxis(stage) == "Z"
    prim = stage.GetPrimAtPath("/World/drape/sim")
    mesh = UsdGeom.Mesh(prim)
    assert mesh.GetSubdivisionSchemeAttr().Get() == "none" and set(mesh.GetFaceVertexCountsAttr().Get()) == {3}
    live = np.array(mesh.GetPointsAttr().Get(), dtype=float)
    rest = np.array(prim.GetAttribute("physics:restShapePoints").Get(), dtype=float)
    triangles = np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)
    assert UsdGeom.Mesh.ValidateTopology(
        mesh.GetFaceVertexIndicesAttr().Get(), mesh.GetFaceVertexCountsAttr().Get(), len(live)
    )[0]
    held = np.array(prim.GetAttribute("kesf:held").Get())
    (material,) = prim.GetRelationship("material:binding:physics").GetTargets()
    material = stage.GetPrimAtPath(material)

    builder = newton.ModelBuilder()
    builder.add_usd(path)
    points = np.array([list(q) for q in builder.particle_q])
    assert points.shape == live.shape and np.abs(points - live).max() < 1e-7
    assert np.array_equal(np.array(builder.tri_indices), triangles)
    # All triangles turn upwards on the table.
    a, b, c = (rest[triangles[:, k]] for k in range(3))
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()
    edges = np.array(builder.edge_indices)
    lengths = np.linalg.norm(points[edges[:, 2]] - points[edges[:, 3]], axis=1)
    inner = (edges[:, 0] >= 0) & (edges[:, 1] >= 0)
    o0, o1, v0, v1 = (points[edges[inner, k]] for k in range(4))
    normals = [np.cross(v0 - o0, v1 - o0), np.cross(v1 - o1, v0 - o1)]
    cosine = (normals[0] * normals[1]).sum(1) / np.linalg.norm(normals[0], axis=1) / np.linalg.norm(normals[1], axis=1)
    stretch, bend = {m[0] for m in builder.tri_materials}, {e[0] for e in builder.edge_bending_properties}
    assert len(stretch) == 1 and len(bend) == 1, (stretch, bend)
    far = farthest(points, triangles)
    disc = farthest(rest, triangles[np.isin(triangles, held).all(axis=1)])
    specimen = farthest(rest, triangles)
    print(json.dumps({
        "area": float(sum(builder.tri_areas)),
        "held_area": float(areas(rest, triangles[np.isin(triangles, held).all(axis=1)]).sum()),
        "mass": float(sum(builder.particle_mass)),
        "tensile": float(stretch.pop()),
        "bend": float(bend.pop()),
        "shear": float(material.GetAttribute("physics:surfaceShearStiffness").Get()),
        "density": float(material.GetAttribute("physics:density").Get()),
        "thickness": float(prim.GetAttribute("physics:thicknesses").Get()[0]),
        "coefficient": float(((far**2).mean() - (disc**2).mean()) / ((specimen**2).mean() - (disc**2).mean())),
        "longer": float((lengths / np.array(builder.edge_rest_length) - 1).max()),
        "area_now": float(areas(points, triangles).sum()),
        "rest_angle": float(np.abs(builder.edge_rest_angle).max()),
        "angle": float(np.arccos(np.clip(cosine, -1, 1)).max()),
        "held_moved": float(np.abs(points[held] - rest[held]).max()),
    }))


if __name__ == "__main__":
    main()
