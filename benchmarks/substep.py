"""What a substep of the rolling robot costs against the engine's own step and against a plain Python cable loop.

The three run in turn on the same motion, block by block in one process pinned to one core, so that the machine's
drifting speed cancels in the ratios. Prints a table; ``--json FILE`` writes the rows too.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import time
from importlib.metadata import version
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import pybullet

from tensegym.cable_forces import LOCAL_A, LOCAL_B
from tensegym.design import Payload, RobotDesign
from tensegym.report import table
from tensegym.robot import TensegrityRobot

BLOCK = 100  # substeps


def bare_block(robot: TensegrityRobot) -> float:
    """Seconds inside stepSimulation while the robot goes on moving as it does."""
    spent = 0.0
    step = pybullet.stepSimulation

    def timed(client: int) -> None:
        nonlocal spent
        began = time.perf_counter()
        step(client)
        spent += time.perf_counter() - began

    pybullet.stepSimulation = timed
    try:
        robot.step(BLOCK)
    finally:
        pybullet.stepSimulation = step
    return spent


def whole_block(robot: TensegrityRobot) -> float:
    began = time.perf_counter()
    robot.step(BLOCK)
    return time.perf_counter() - began


def naive_block(robot: TensegrityRobot) -> float:
    """The obvious way: a Python loop over cables, two forces each, end points by multiplyTransforms."""
    world, cables, client = robot.world, robot.cables, robot.world.client
    natural, last = robot.natural_lengths, robot.lengths.copy()
    began = time.perf_counter()
    for _ in range(BLOCK):
        poses = [pybullet.getBasePositionAndOrientation(body, client) for body in world.bodies]
        for c, (a, b) in enumerate(cables.ends):
            pa, _ = pybullet.multiplyTransforms(*poses[a], cables.params[c, LOCAL_A].tolist(), [0, 0, 0, 1])
            pb, _ = pybullet.multiplyTransforms(*poses[b], cables.params[c, LOCAL_B].tolist(), [0, 0, 0, 1])
            span = np.subtract(pb, pa)
            length = np.linalg.norm(span)
            stretch = length - natural[c]
            tension = max(0.0, 300.0 * stretch + 5.0 * (length - last[c]) / robot.dt) if stretch > 0 else 0.0
            last[c] = length
            force = tension / length * span
            pybullet.applyExternalForce(world.bodies[a], -1, force, pa, pybullet.WORLD_FRAME, client)
            pybullet.applyExternalForce(world.bodies[b], -1, -force, pb, pybullet.WORLD_FRAME, client)
        pybullet.stepSimulation(client)
    return time.perf_counter() - began


def measure(design: RobotDesign, dt: float, rounds: int) -> dict[str, np.ndarray]:
    """Microseconds a substep, one value a round, for each way."""
    rng = np.random.default_rng(0)
    spent: dict[str, list[float]] = {"substep": [], "bare step": [], "naive loop": []}
    with TensegrityRobot(design, dt=dt) as robot, TensegrityRobot(design, dt=1e-3) as naive:
        robot.reset(0)
        robot.step(500)
        for _ in range(rounds):
            robot.command(rng.uniform(0, 1, len(robot.drives)) * robot.command_limit)
            spent["substep"].append(whole_block(robot))
            spent["bare step"].append(bare_block(robot))
            naive.reset(0)
            spent["naive loop"].append(naive_block(naive))
    return {name: np.array(values) / BLOCK * 1e6 for name, values in spent.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=60)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    rows = []
    for name, design, dt in (
        ("explicit, 1 ms", RobotDesign(), 1e-3),
        ("implicit, 2 ms", RobotDesign(), 2e-3),
        ("implicit, 2 ms, payload", RobotDesign(payload=Payload()), 2e-3),
    ):
        spent = measure(design, dt, arguments.rounds)
        for peer in ("bare step", "naive loop"):
            ratios = np.quantile(spent["substep"] / spent[peer], [0.1, 0.5, 0.9])
            rows.append({"name": f"{name} / {peer}", "ours": float(np.median(spent["substep"])),
                         "peer": float(np.median(spent[peer])), "unit": "us a substep", "ratio": float(ratios[1]),
                         "spread": [float(ratios[0]), float(ratios[2])]})  # fmt: skip
    print(table(["substep / peer", "ours us", "peer us", "ratio", "10 to 90 %"],
                [[r["name"], r["ours"], r["peer"], r["ratio"], f"{r['spread'][0]:.3g} to {r['spread'][1]:.3g}"]
                 for r in rows]))  # fmt: skip
    if arguments.json:
        machine = {"processor": platform.processor() or platform.machine(), "python": platform.python_version()}
        machine |= {name: version(name) for name in ("pybullet", "numba", "numpy")}
        arguments.json.write_text(json.dumps({"machine": machine, "rows": rows}, indent=1))


if __name__ == "__main__":
    main()
