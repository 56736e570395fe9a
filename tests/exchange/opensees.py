"""An OpenSees card, executed by OpenSeesPy: ASDShellQ4, corotational where rotations are large."""

import importlib.metadata
import runpy

import openseespy.opensees as ops

import problems

# Its tangent is not that of large rotations: Krylov acceleration, and smaller steps than those of the others.
STEPS = 2


def solve(path, problem):
    card = runpy.run_path(path)
    mesh = problem.mesh
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    card["section"](ops, 1)
    for k, (x, y) in enumerate(mesh.points):
        ops.node(k + 1, x, y, 0.0)
    for k, dofs in problem.fixed.items():
        ops.fix(k + 1, *(int(d in dofs) for d in problems.ALL))
    corotational = ["-corotational"] if problem.nonlinear else []
    for e, quad in enumerate(mesh.quads):
        ops.element("ASDShellQ4", e + 1, *(k + 1 for k in quad), 1, *corotational, "-local", 1.0, 0.0, 0.0)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    (a, b), (n, m) = mesh.size, mesh.cells
    mass = card["AREAL_DENSITY"] * (a / n) * (b / m) / 4.0
    loads = {k: list(f) for k, f in problem.forces.items()}
    for quad in mesh.quads:
        for k in quad:
            load = loads.setdefault(k, [0.0, 0.0, 0.0])
            for i in range(3):
                load[i] += mass * problem.acceleration[i]
    for k, (fx, fy, fz) in loads.items():
        ops.load(k + 1, fx, fy, fz, 0.0, 0.0, 0.0)
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.test("NormDispIncr", 1e-9, 100, 0)
    ops.algorithm("KrylovNewton" if problem.nonlinear else "Linear")
    steps = STEPS * problem.steps if problem.nonlinear else 1
    ops.integrator("LoadControl", 1.0 / steps)
    ops.analysis("Static")
    if ops.analyze(steps) != 0:
        raise SystemExit("OpenSees did not converge")
    return [ops.nodeDisp(k + 1) for k in range(len(mesh.points))]


if __name__ == "__main__":
    problems.main("OpenSeesPy " + importlib.metadata.version("openseespy"), solve)
