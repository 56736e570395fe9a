"""A MuJoCo card, executed as it is: both strips of the scene, until they rest."""

import sys

import mujoco
import numpy as np

import problems

REST, LONGEST = 1e-6, 60.0


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
        answers[name] = float((end - start)[middle][measured(along)])
    return answers


def main():
    path, wanted, answers = sys.argv[1], sys.argv[2:], {}
    if any(name.startswith("strip") for name in wanted):
        for name, moved in strips(path, (0, 0, -problems.G), lambda _: 2).items():
            answers["strip_" + name] = -moved / problems.STRIP
    for along, name in enumerate(("warp", "weft")):
        if "hang_" + name in wanted:
            pull = [0.0, 0.0, 0.0]
            pull[along] = problems.HANG_GRAVITY
            answers["hang_" + name] = strips(path, pull, lambda a: a)[name] / problems.STRIP
    problems.answer("MuJoCo " + mujoco.__version__, {k: v for k, v in answers.items() if k in wanted})


if __name__ == "__main__":
    main()
