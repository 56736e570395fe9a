"""A Blender card, executed as it is by Blender's Python module: its settings as Blender keeps them, and its strips.

What Blender keeps is turned back by its own rules (force unit 1000 N, one tenth in a hinge), written down here again.
"""

import runpy
import sys

import bpy
import numpy as np
import problems

REST, LONGEST = 1e-6, 1000
# Hanging strips: a tenth of the load, so that the springs stay linear.
SHARE = 0.1


def points(body, along, across):
    evaluated = body.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return np.array([v.co[:] for v in evaluated.data.vertices]).reshape(along + 1, across + 1, 3)


def opened(path):
    """An empty scene with what the card puts there."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    card = runpy.run_path(path)
    return card, card["build"]()


def settle(path, gravity):
    """The middle line of each strip (m) where it rests, in its own axes: along, across, up."""
    card, bodies = opened(path)
    scene = bpy.context.scene
    scene.gravity = gravity
    along, across, lengths = card["ALONG"], card["ACROSS"], card["LENGTHS"]
    before = None
    for frame in range(1, LONGEST + 1):
        scene.frame_set(frame)
        now = np.array([points(b, along, across) for b in bodies]) / lengths
        if frame > 50 and np.abs(now - before).max() < REST * problems.STRIP:
            break
        before = now
    else:
        raise SystemExit("Blender did not come to rest")
    warp, weft = now
    weft = np.stack([-weft[..., 1], weft[..., 0], weft[..., 2]], axis=-1)
    middle = across // 2
    return card, {"warp": warp[:, middle], "weft": weft[:, middle]}


def kept(card, body, yarn):
    """Constants of a strip, from the settings that Blender keeps."""
    s = body.modifiers["Cloth"].settings
    side, lengths, masses = card["SIDE"], card["LENGTHS"], card["MASSES"]
    # What a unit of force and a square are in the scale of the card.
    newton, square = 1000.0 / masses, side * lengths
    share = card["ACROSS"] / (card["ACROSS"] + 1)
    shear = s.shear_stiffness * newton / side
    sides = s.tension_stiffness * newton / (side * share) + shear
    return {
        f"tensile_{yarn}": sides - shear**2 / sides,
        # The force of a hinge on the middles of two squares, half a side away.
        f"rigidity_{yarn}": 0.1 * s.bending_stiffness * square * newton * side / 2,
        "shear": shear,
        "mass": s.mass / (masses * share) / side**2,
    }


def main():
    path, wanted, answers = sys.argv[1], sys.argv[2:], {}
    card, bodies = opened(path)
    for body, yarn in zip(bodies, ("warp", "weft")):
        answers.update(kept(card, body, yarn))
    if any(name.startswith("strip") for name in wanted):
        for yarn, line in settle(path, (0.0, 0.0, -problems.G))[1].items():
            # Cloth ends half a square behind the last point.
            end = 1.5 * line[-1] - 0.5 * line[-2]
            answers["strip_" + yarn] = -end[2] / problems.STRIP
    for axis, yarn in enumerate(("warp", "weft")):
        if "hang_" + yarn not in wanted:
            continue
        pull = [0.0, 0.0, 0.0]
        pull[axis] = (1, -1)[axis] * SHARE * problems.HANG_GRAVITY
        card, lines = settle(path, pull)
        side, n, line = card["SIDE"], card["ALONG"], lines[yarn]
        # For stretching the strip begins at the last row that is held, and every row has a whole square of mass.
        free = (n - 1) * side
        moved = line[-1][0] - (n - 0.5) * side
        answers["hang_" + yarn] = moved / SHARE * problems.STRIP / (free * (free + side))
    problems.answer("Blender " + bpy.app.version_string.split()[0], {k: float(answers[k]) for k in wanted})


if __name__ == "__main__":
    main()
