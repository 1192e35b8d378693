"""Coulomb's friction, 0.3 to 1.2: how far a rod slides, at which slope rod and robot start to slide, creep at rest."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.design.bodies import design_bodies
from tensegym.design.design import RobotDesign
from tensegym.robot.robot import TensegrityRobot
from tensegym.validation.free_bodies import FreeBodies
from tensegym.validation.row import Findings, Row

COEFFICIENTS = (0.3, 0.5, 0.8, 1.2)
GRAVITY = 9.81
ALONG_X = Rotation.from_euler("y", 90, degrees=True).as_quat()  # a rod, whose own axis is z, laid down
MOVES = 5e-3  # m/s: slides


def stopping(engine: str, dt: float = 1e-3) -> Findings:
    """A rod of the robot slides along itself at 2 m/s and stops after v^2 / (2 mu g)."""
    rows, speed = [], 2.0
    for mu in COEFFICIENTS:
        exact, touching, pushes = speed**2 / (2 * mu * GRAVITY), 0, [0.0]
        with _lying(engine, mu, dt) as rod:
            rod.start(_laid(), np.array([[speed, 0, 0, 0, 0, 0]]))
            slides, weight = round(speed / (mu * GRAVITY) / dt), float(rod.model.masses[0]) * GRAVITY
            for step in range(round(1.5 * slides)):
                rod.step(np.zeros((1, 6)))
                if step < slides:
                    contacts = rod.world.contacts()
                    touching += bool(contacts)
                    pushes.append(sum(contact.push for contact in contacts) / weight)
            far = float(rod.poses[0, 0])
        share = 100 * touching / slides
        note = (f"At mu {mu:g} it touches in {share:.0f} % of the steps of its slide, pushed by up to "
                f"{max(pushes):.2g} times its weight.")  # fmt: skip
        rows.append(Row("stopping", f"a rod slides this far at mu {mu:g}, m", exact, far, speed * dt, dt, note))
    return Findings(rows)


def slope(engine: str, dt: float = 1e-3) -> Findings:
    """Gravity is tilted by 0.1 deg every 0.2 s: at atan(mu) a rod that lies downhill starts to slide, and so does the
    robot on a closed face where it does not tip first."""
    rows = []
    for mu in COEFFICIENTS:
        with _lying(engine, mu, dt) as rod:
            rod.start(_laid(), np.zeros((1, 6)))
            wanted = np.degrees(np.arctan(mu))
            measured = wanted - 3
            while measured < wanted + 3 and abs(rod.velocities[0, 0]) < MOVES:
                measured += 0.1
                tilt = np.radians(measured)
                rod.world.set_gravity([GRAVITY * np.sin(tilt), 0, -GRAVITY * np.cos(tilt)])
                for _ in range(round(0.2 / dt)):
                    rod.step(np.zeros((1, 6)))
        rows.append(Row("slope", f"a rod slides from this slope on at mu {mu:g}, deg", wanted, measured, 0.3, dt))
    return Findings([*rows, *_robot_on_slopes(engine, dt)])


def _robot_on_slopes(engine: str, dt: float) -> list[Row]:
    """At mu 0.3 it slides; at 0.8 it tips first, where its weight passes over the edge of the feet it stands on, bent
    downhill as it then is."""
    rows = []
    for mu, how in ((0.3, "slides"), (0.8, "tips over")):
        with TensegrityRobot(RobotDesign(friction=mu), dt=dt, engine=engine) as robot:
            robot.reset(int(np.flatnonzero(robot.faces.closed)[0]))
            measured, balance = _leaves_from(robot, 12.0, 30.0)
        wanted = np.degrees(min(balance, np.arctan(mu)))
        rows.append(Row("slope", f"the robot {how} from this slope on at mu {mu:g}, deg", wanted, measured, 1.0, dt))
    return rows


def _balance(robot: TensegrityRobot) -> float:
    """Slope [rad], rising along x, on which the robot's weight points at the edge of its feet, were it rigid."""
    feet = robot.node_positions_in_world()[robot.foot_contacts() > 0][:, :2]
    centre = robot.centre_of_mass_in_world()
    edges = []
    for a, b in combinations(feet - centre[:2], 2):
        part = a[1] / (a[1] - b[1])  # where the edge meets the line downhill
        if 0 <= part <= 1:
            edges.append(a[0] + part * (b[0] - a[0]))
    return float(np.arctan(-min(edges) / centre[2]))


def _leaves_from(robot: TensegrityRobot, angle: float, most: float) -> tuple[float, float]:
    """First slope [deg] from ``angle`` on at which every foot on the ground moves, ``most`` if at none; and `_balance`
    when it last stood."""
    balance = np.pi / 2
    for fraction in np.linspace(0.05, 1, 20):  # it sways on its cables where the slope jumps
        robot.slope(np.radians(fraction * angle), np.array([1.0, 0.0]))
        robot.step(round(0.2 / robot.dt))
    while angle < most:
        angle += 0.1
        robot.slope(np.radians(angle), np.array([1.0, 0.0]))
        robot.step(round(0.1 / robot.dt))
        grounded, before = robot.foot_contacts() > 0, robot.node_positions_in_world()
        robot.step(round(0.1 / robot.dt))
        way = np.linalg.norm((robot.node_positions_in_world() - before)[grounded, :2], axis=1)
        if way.min() > 0.1 * MOVES:
            break
        balance = _balance(robot) if grounded.sum() == 3 else balance
    return angle, balance


def creep(engine: str, seconds: float = 60.0) -> Findings:
    """A robot left alone on a closed face, on the level and on a slope of 10 deg, is where it was."""
    rows, curves = [], {}
    for dt in (1e-3, 2e-3, 4e-3):
        for angle in (0.0, 10.0):
            with TensegrityRobot(dt=dt, engine=engine) as robot:
                robot.reset(int(np.flatnonzero(robot.faces.closed)[0]))
                robot.slope(np.radians(angle), np.array([1.0, 0.0]))
                robot.step(round(2.0 / dt))
                start, way = robot.centre_of_mass_in_world()[:2], []
                for _ in range(30):
                    robot.step(round(seconds / 30 / dt))
                    way.append(float(np.linalg.norm(robot.centre_of_mass_in_world()[:2] - start)))
                length = robot.design.length
            where = "on a slope of 10 deg" if angle else "on the level"
            moved = f"moved in {seconds:g} s {where} at {1e3 * dt:g} ms, rod lengths"
            rows.append(Row("creep", moved, 0.0, way[-1] / length, 0.01, dt))
            curves[f"{where}, {1e3 * dt:g} ms"] = [1e3 * w for w in way]
    times = (np.arange(1, 31) * seconds / 30).tolist()
    return Findings(rows, {"time, s": times, "way, mm": curves})


def _lying(engine: str, mu: float, dt: float) -> FreeBodies:
    return FreeBodies(engine, [design_bodies(RobotDesign())[0]], dt, mu, GRAVITY)


def _laid() -> np.ndarray:
    design = RobotDesign()
    height = max(design.rod(0).foot_radius, design.rod(0).tube_outer_radius)
    return np.array([[0, 0, height, *ALONG_X]])
