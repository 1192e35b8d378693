"""The height at which the robot comes to rest on each face that it can rest on."""

from __future__ import annotations

import numpy as np

from tensegym.design.design import RobotDesign
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.settling import resting_faces

from .part import ENGINES, Part

SETTLING, LOOKING, LOOKS = 2.0, 1.0, 50  # s, s, times: it breathes on at rest, so that heights are means
TOLERANCE = 1e-3  # m


def settling(design: RobotDesign, dt: float) -> Part:
    """Drives at zero, on every face with the foot of the perpendicular from the centre of mass in it."""
    heights, sunk, spread = {}, {}, {}
    for engine in ENGINES:
        with TensegrityRobot(design, dt=dt, engine=engine) as robot:
            faces = resting_faces(robot)
            names = [robot.faces.names()[face] for face in faces]
            heights[engine], sunk[engine], *sides = np.array([_settle(robot, face) for face in faces]).T
            spread[engine] = np.array(sides)
    difference = heights[ENGINES[1]] - heights[ENGINES[0]]
    most = float(np.abs(difference).max())
    deeper = float((sunk[ENGINES[1]] - sunk[ENGINES[0]]).mean())
    wider = float(np.abs(spread[ENGINES[1]] - spread[ENGINES[0]]).max())
    verdict = (f"At rest heights differ by at most {1e3 * most:.2g} mm: feet sink {1e3 * deeper:.2g} mm deeper into "
               "MuJoCo's ground, which gives way, and friction holds them where they came to stand under the weight, "
               f"up to {1e3 * wider:.2g} mm nearer to or farther from each other.")  # fmt: skip
    rows = [[name, *(1e3 * float(h[i]) for h in heights.values()), 1e3 * float(difference[i])]
            for i, name in enumerate(names)]  # fmt: skip
    return Part("settling", ["face", *(f"{engine} mm" for engine in ENGINES), "difference mm"], rows, most <= TOLERANCE,
                verdict, {"faces": names, "difference_m": difference.tolist()})  # fmt: skip


def _settle(robot: TensegrityRobot, face: int) -> tuple[float, ...]:
    """Mean height of the centre of mass, how far the lowest foot is in the ground, the face's three sides [m]."""
    robot.reset(face)
    robot.step(round(SETTLING / robot.dt))
    heights, sunk = [], []
    for _ in range(LOOKS):
        robot.step(round(LOOKING / LOOKS / robot.dt))
        heights.append(robot.centre_of_mass_in_world()[2])
        sunk.append(-(robot.node_positions_in_world()[:, 2] - robot.model.foot_radii).min())
    corners = robot.node_positions_in_world()[robot.faces.triangles[face]]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)
    return float(np.mean(heights)), float(np.mean(sunk)), *sides.tolist()
