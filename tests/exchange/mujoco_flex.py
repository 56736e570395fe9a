"""A MuJoCo card, executed as it is: both strips of the scene, until they rest."""

import sys

import mujoco
import numpy as np

import problems

REST, LONGEST = 1e-6, 60.0
# MuJoCo has no linear analysis: a strip hangs in a tenth of the load, and its elongation is multiplied by ten.
SHARE = 0.1


def settle(path, gravity):
    model = mujoco.MjModel.from_xml_path(path)
    model.opt.gravity[:] = gravity
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    start = data.flexvert_xpos.copy()
    while data.time < LONGEST:
        mujoco.mj_step(model, data)
        if data.time > 0.5 and np.abs(data.qvel).max() < REST:
            break
    else:
        raise SystemExit("MuJoCo did not come to rest")
    return model, start, data.flexvert_xpos


def strips(path, gravity, measured):
    model, start, end = settle(path, gravity)
    answers = {}
    for name, along in (("warp", 0), ("weft", 1)):
        flex = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_FLEX, name)
        first, count = model.flex_vertadr[flex], model.flex_vertnum[flex]
        tip = np.flatnonzero(start[first : first + count, along] > problems.STRIP - 1e-6) + first
        middle = tip[len(tip) // 2]
        # For stretching the strip begins at the last row of points that are held; a strip of 4 cm has the square of
        # the lengths for its elongation.
        held = np.flatnonzero(model.body_weldid[model.flex_vertbodyid[first : first + count]] == 0) + first
        free = start[middle, along] - start[held, along].max()
        answers[name] = float((end - start)[middle][measured(along)]), free
    return answers


def main():
    path, wanted, answers = sys.argv[1], sys.argv[2:], {}
    if any(name.startswith("strip") for name in wanted):
        for name, (moved, _) in strips(path, (0, 0, -problems.G), lambda _: 2).items():
            answers["strip_" + name] = -moved / problems.STRIP
    for along, name in enumerate(("warp", "weft")):
        if "hang_" + name in wanted:
            pull = [0.0, 0.0, 0.0]
            pull[along] = SHARE * problems.HANG_GRAVITY
            moved, free = strips(path, pull, lambda a: a)[name]
            answers["hang_" + name] = moved / SHARE * problems.STRIP / free**2
    problems.answer("MuJoCo " + mujoco.__version__, {k: v for k, v in answers.items() if k in wanted})


if __name__ == "__main__":
    main()
