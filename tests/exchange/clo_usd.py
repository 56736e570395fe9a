"""A card with CLO's attributes, read by Pixar's USD as Unreal Engine's importer reads it.

The importer (`USDImportNode_v2.cpp`) looks for a prim with `ClothRootAPI`, a mesh below it with `SimMeshDataAPI` and a subset
of its faces with `SimPatternAPI`, takes the first value of each `primvars:clo:*` array and multiplies by the factors below.
"""

import sys

import problems
from pxr import Usd, UsdGeom

BENDING = 1e-5 * 1e-4  # to kg cm2/s2, and from there to N m
STRETCH, DENSITY, THICKNESS = 1e-3, 1e3, 1e-1 * 1e-2


def with_schema(prim, name):
    schemas = [p for p in prim.GetChildren() if name in p.GetPrimTypeInfo().GetAppliedAPISchemas()]
    assert len(schemas) == 1, (prim, name)
    return schemas[0]


def main():
    stage = Usd.Stage.Open(sys.argv[1])
    mesh = with_schema(with_schema(stage.GetPseudoRoot(), "ClothRootAPI"), "SimMeshDataAPI")
    pattern = with_schema(mesh, "SimPatternAPI")
    subset = UsdGeom.Subset(pattern)
    assert (subset.GetFamilyNameAttr().Get(), subset.GetElementTypeAttr().Get()) == ("pattern", "face")
    faces = UsdGeom.Mesh(mesh).GetFaceVertexCountsAttr().Get()
    assert set(faces) == {3} and list(subset.GetIndicesAttr().Get()) == list(range(len(faces)))

    def of(name):
        return float(pattern.GetAttribute("primvars:clo:" + name).Get()[0])

    assert of("shearLeft") == of("shearRight") and of("bendingBiasLeft") == of("bendingBiasRight")
    answers = {
        "tensile_warp": of("stretchWarp") * STRETCH,
        "tensile_weft": of("stretchWeft") * STRETCH,
        "shear": of("shearLeft") * STRETCH,
        "rigidity_warp": of("bendingWarp") * BENDING,
        "rigidity_weft": of("bendingWeft") * BENDING,
        "mass": of("density") * DENSITY,
        "thickness": of("thickness") * THICKNESS,
    }
    problems.answer("USD " + ".".join(map(str, Usd.GetVersion())), {name: answers[name] for name in sys.argv[2:]})


if __name__ == "__main__":
    main()
