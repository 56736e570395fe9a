"""A Kratos materials file, executed: thin quadrilateral shells, corotational."""

import importlib.metadata
import json
import os
import sys
import types

import KratosMultiphysics as km
import KratosMultiphysics.ConstitutiveLawsApplication  # noqa: F401  the orthotropic law
import KratosMultiphysics.LinearSolversApplication as solvers
import KratosMultiphysics.StructuralMechanicsApplication as structural

import problems

km.Logger.GetDefaultOutput().SetSeverity(km.Logger.Severity.WARNING)
TRANSLATIONS = (km.DISPLACEMENT_X, km.DISPLACEMENT_Y, km.DISPLACEMENT_Z)
ROTATIONS = (km.ROTATION_X, km.ROTATION_Y, km.ROTATION_Z)
REACTIONS = (km.REACTION_X, km.REACTION_Y, km.REACTION_Z)
MOMENTS = (km.REACTION_MOMENT_X, km.REACTION_MOMENT_Y, km.REACTION_MOMENT_Z)


def empty():
    model = km.Model()
    part = model.CreateModelPart("Structure")
    part.ProcessInfo[km.DOMAIN_SIZE] = 3
    for variable in (
        km.DISPLACEMENT,
        km.ROTATION,
        km.REACTION,
        km.REACTION_MOMENT,
        km.VOLUME_ACCELERATION,
        structural.POINT_LOAD,
    ):
        part.AddNodalSolutionStepVariable(variable)
    return model, part


def solve(path, problem):
    mesh = problem.mesh
    model, part = empty()
    sheet = part.CreateSubModelPart("sheet")
    for k, (x, y) in enumerate(mesh.points):
        sheet.CreateNewNode(k + 1, x, y, 0.0)
    properties = part.CreateNewProperties(1)
    for e, quad in enumerate(mesh.quads):
        sheet.CreateNewElement("ShellThinElementCorotational3D4N", e + 1, [k + 1 for k in quad], properties)
    for c, k in enumerate(problem.forces):
        part.CreateNewCondition("PointLoadCondition3D1N", c + 1, [k + 1], properties)
    return run(path, model, part, problem)


def mesh_strip(path, yarn):
    """The strips of the mdpa file beside the materials, read by Kratos itself; drop of one tip over its length."""
    model, part = empty()
    km.ModelPartIO(os.path.join(os.path.dirname(path), "card")).ReadModelPart(part)
    fixed = {n.Id - 1: problems.ALL for y in ("warp", "weft") for n in part.GetSubModelPart("held_" + y).Nodes}
    shares = [step / 10 for step in range(1, 11)]
    problem = types.SimpleNamespace(
        fixed=fixed, forces={}, acceleration=(0.0, 0.0, -problems.G), shares=lambda: shares
    )
    moved = run(path, model, part, problem)
    along = 0 if yarn == "warp" else 1
    nodes = list(part.GetSubModelPart("strip_" + yarn).Nodes)
    across = [(n.X0, n.Y0)[1 - along] for n in nodes]
    middle = (min(across) + max(across)) / 2
    ends = sorted(nodes, key=lambda n: (-round((n.X0, n.Y0)[along], 9), abs((n.X0, n.Y0)[1 - along] - middle)))
    return -moved[ends[0].Id - 1][2] / problems.STRIP


def run(path, model, part, problem):
    settings = {"Parameters": {"materials_filename": path}}
    km.ReadMaterialsUtility(km.Parameters(json.dumps(settings)), model)
    for variable, reaction in zip(TRANSLATIONS + ROTATIONS, REACTIONS + MOMENTS):
        km.VariableUtils().AddDof(variable, reaction, part)
    part.SetBufferSize(2)
    for k, dofs in problem.fixed.items():
        for dof in dofs:
            part.Nodes[k + 1].Fix((TRANSLATIONS + ROTATIONS)[dof - 1])
    strategy = km.ResidualBasedNewtonRaphsonStrategy(
        part,
        km.ResidualBasedIncrementalUpdateStaticScheme(),
        km.ResidualCriteria(1e-8, 1e-14),
        km.ResidualBasedBlockBuilderAndSolver(solvers.SparseLUSolver()),
        50,
        True,
        False,
        True,
    )
    strategy.SetEchoLevel(0)
    strategy.Initialize()
    for step, share in enumerate(problem.shares(), 1):
        part.CloneTimeStep(float(step))
        pull = km.Array3([share * a for a in problem.acceleration])
        for node in part.Nodes:
            node.SetSolutionStepValue(km.VOLUME_ACCELERATION, pull)
        for k, force in problem.forces.items():
            load = km.Array3([share * f for f in force])
            part.Nodes[k + 1].SetSolutionStepValue(structural.POINT_LOAD, load)
        strategy.InitializeSolutionStep()
        strategy.Predict()
        converged = strategy.SolveSolutionStep()
        strategy.FinalizeSolutionStep()
        if not converged:
            raise SystemExit("Kratos did not converge")
    return [list(n.GetSolutionStepValue(km.DISPLACEMENT)) for n in part.Nodes]


if __name__ == "__main__":
    wanted = [name for name in sys.argv[2:] if name.startswith("mesh_strip_")]
    more = {name: mesh_strip(sys.argv[1], name[-4:]) for name in wanted}
    problems.main("Kratos " + importlib.metadata.version("KratosMultiphysics"), solve, more)
