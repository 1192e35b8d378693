"""A flexure joint in PyBullet: simulated seconds per CPU second against error, and the design's alternatives.

    python benchmarks/flexure_joint.py [--json FILE]

The paper's stand, its arm let go from 20 deg, no damping, one process on one thread. Errors are against DOP853 of the
same three equations, written here a second time, at 1e-10. Tables:

1. explicit forces, linearly implicit ones (one Newton iteration), the trapezoid, from 0.1 to 4 ms
2. the joint rewritten in the URDF against two separate bodies held by forces in all six directions
3. the same arm on a beam of exudyn (ANCF cables, light, implicit trapezoidal), timed beside ours in turns
"""

from __future__ import annotations

import argparse
import json
import os
import time
import warnings
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
import pybullet
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from tensegym.bullet import packaged_urdf
from tensegym.compiled import kernel
from tensegym.errors import SimulationError
from tensegym.flexible.flexible_robot import FlexibleRobot
from tensegym.flexible.flexure_joint import FlexureJoint
from tensegym.flexible.stand import ARM, UPRIGHT, arm_state, pull
from tensegym.flexure.hinge import PAPER_HINGES, preset
from tensegym.flexure.models.joint import Joint
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.flexure.models.potential_kernel import stiffness, wrench
from tensegym.report import table

MASS, CENTRE, INERTIA = 0.03, 0.06, 3.7e-5  # of the stand's arm: kg, m beyond the tip, kg m^2 about the centre
RELEASE = np.radians(20.0)
STEPS = (1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 4e-3)
SECONDS = 1.0


@kernel
def slope(coefficients, scales, state):
    """d/dt (x, y, theta, rates): Newton-Euler of the arm about its centre."""
    fx, fy, moment, _ = wrench(coefficients, scales, state[0], state[1], state[2])
    c, s, rate = CENTRE * np.cos(state[2]), CENTRE * np.sin(state[2]), state[5]
    turn = -(moment + s * fx - c * fy) / INERTIA
    out = np.empty(6)
    out[:3] = state[3:]
    out[3] = -fx / MASS + c * rate**2 + s * turn
    out[4] = -fy / MASS + s * rate**2 - c * turn
    out[5] = turn
    return out


def reference(joint: Joint, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Times every 0.1 ms and theta."""
    spring = joint.models["potential"]
    _, tip = arm_state(spring, RELEASE, joint.box.max_force)
    times = np.arange(round(seconds * 1e4) + 1) * 1e-4
    run = solve_ivp(lambda _, s: slope(spring.coefficients, spring.scales, s), (0, times[-1]),
                    [*tip, RELEASE, 0, 0, 0], "DOP853", times, rtol=1e-10, atol=1e-12)  # fmt: skip
    return times, run.y[2]


def frequency(times: np.ndarray, theta: np.ndarray) -> float:
    i = np.flatnonzero((theta[:-1] > 0) & (theta[1:] <= 0))
    zeros = times[i] + theta[i] / (theta[i] - theta[i + 1]) * (times[i + 1] - times[i])
    return float((len(zeros) - 1) / (zeros[-1] - zeros[0])) if len(zeros) > 1 else np.nan


def swing(joint: Joint, dt: float, scheme: str, seconds: float, sideways: list[float] | None = None
          ) -> tuple[np.ndarray, float]:  # fmt: skip
    """Theta at every step, and CPU seconds of the stepping. ``sideways``: gravity of 9.81 along the hinge's axis; the
    list takes how far the arm's frame was out of the plane at the end [m] and how its axis points out of it [rad]."""
    axis = Rotation.from_quat(UPRIGHT[3:]).apply([0.0, 0.0, 1.0])
    gravity = np.zeros(3) if sideways is None else -9.81 * axis
    with FlexibleRobot(packaged_urdf("flexure_stand.urdf"), dt=dt, gravity=gravity, pose=UPRIGHT, fixed_base=True,
                       scheme=scheme) as robot:  # fmt: skip
        flexure = FlexureJoint(robot, "hinge", joint)
        _, tip = arm_state(flexure.spring, RELEASE, joint.box.max_force)
        robot.place(robot.place_tip("hinge", [*tip, RELEASE]))
        column = robot.joints["hinge"]
        theta = [RELEASE]
        began = time.process_time()
        for _ in range(round(seconds / dt)):
            robot.step()
            theta.append(robot.positions[column])
        spent = time.process_time() - began
        if sideways is not None:
            # as the engine has the link, not as our own tree does
            place, quaternion = robot.body.link_frames()[robot.links["arm"] - 1]
            along = Rotation.from_quat(quaternion).apply([1.0, 0.0, 0.0])
            sideways += [abs(float(axis @ place)), abs(float(axis @ along))]
        return np.array(theta), spent


def errors(theta: np.ndarray, dt: float, times: np.ndarray, exact: np.ndarray) -> tuple[float, float]:
    """Root mean square of theta's error over 20 deg, and the relative error of the frequency."""
    grid = dt * np.arange(len(theta))
    miss = theta - np.interp(grid, times, exact)
    return float(np.sqrt(np.mean(miss**2)) / RELEASE), abs(frequency(grid, theta) / frequency(times, exact) - 1)


def work_precision(joint: Joint, name: str) -> list[dict]:
    rows = []
    times, exact = reference(joint, SECONDS)
    for scheme in ("explicit", "linear", "trapezoid"):
        for dt in STEPS:
            row = {"hinge": name, "scheme": scheme, "dt_ms": 1e3 * dt}
            try:
                theta, spent = swing(joint, dt, scheme, SECONDS)
                error, off = errors(theta, dt, times, exact)
                row |= {"error": error, "frequency_error": off, "real_time": SECONDS / spent}
            except SimulationError as problem:
                row["note"] = "diverged" if "diverged" in str(problem) else "no forces found"
            rows.append(row)
    return rows


class SeparateBody:
    """Design b: the arm a body of its own, the wrench of the spring and an out-of-plane hold as external forces.

    In the plane linearly implicit, as the step kernel's first Newton iteration. Out of it a penalty on z and on the
    turns about x and y, as stiff as explicit forces hold: half a mass over dt^2, damped.
    """

    def __init__(self, joint: Joint, dt: float, gravity: float) -> None:
        self.spring, self.dt, self.gravity = joint.models["potential"], dt, gravity
        self.client = client = pybullet.connect(pybullet.DIRECT)
        pybullet.setTimeStep(dt, physicsClientId=client)
        self.body = pybullet.createMultiBody(MASS, physicsClientId=client)
        pybullet.changeDynamics(self.body, -1, linearDamping=0, angularDamping=0,
                                localInertiaDiagonal=[1e-6, INERTIA, INERTIA], physicsClientId=client)  # fmt: skip
        _, tip = arm_state(self.spring, RELEASE, joint.box.max_force)
        centre = tip + CENTRE * np.array([np.cos(RELEASE), np.sin(RELEASE)])
        turn = pybullet.getQuaternionFromEuler([0, 0, RELEASE])
        pybullet.resetBasePositionAndOrientation(self.body, [*centre, 0.0], turn, physicsClientId=client)
        self.theta, self.tip_height, self.droop = RELEASE, 0.0, 0.0

    def step(self) -> None:
        client, body, dt = self.client, self.body, self.dt
        place, q = pybullet.getBasePositionAndOrientation(body, client)
        v, w = pybullet.getBaseVelocity(body, client)
        r = np.array(pybullet.getMatrixFromQuaternion(q)).reshape(3, 3)
        theta = float(np.arctan2(r[1, 0], r[0, 0]))
        c, s, spin = CENTRE * np.cos(theta), CENTRE * np.sin(theta), w[2]
        k = np.empty((3, 3))
        pose = np.array([place[0] - c, place[1] - s, theta])
        force = -np.array(stiffness(self.spring.coefficients, self.spring.scales, *pose, k)[:3])
        mass = np.array([[MASS, 0, -MASS * s], [0, MASS, MASS * c], [-MASS * s, MASS * c, INERTIA + MASS * CENTRE**2]])
        bias = -MASS * spin**2 * np.array([c, s, 0.0])
        force = force - 0.25 * dt * dt * k @ np.linalg.solve(mass + 0.25 * dt * dt * k, force - bias)
        self.theta, self.droop = theta, float(np.arcsin(np.clip(-r[2, 0], -1, 1)))
        self.tip_height = place[2] - CENTRE * r[2, 0]
        rise = v[2] - CENTRE * (w[0] * r[1, 0] - w[1] * r[0, 0])
        light = 1 / (1 / MASS + CENTRE**2 / INERTIA)  # what the tip weighs across the arm
        up = -light * (0.5 * self.tip_height / dt**2 + 0.5 * rise / dt)
        tilt, along, across = np.array([-r[1, 2], r[0, 2], 0.0]), r[:, 0], r[:, 1]
        turn = np.array([w[0], w[1], 0.0])
        hold = sum(-i * axis * (0.5 * (tilt @ axis) / dt**2 + 0.5 * (turn @ axis) / dt)
                   for i, axis in ((1e-6, along), (INERTIA, across)))  # fmt: skip
        at = [float(pose[0]), float(pose[1]), float(self.tip_height)]
        pybullet.applyExternalForce(body, -1, [float(force[0]), float(force[1]), float(up)], at, 2, client)
        pybullet.applyExternalForce(body, -1, [0.0, 0.0, -self.gravity * MASS], place, 2, client)
        pybullet.applyExternalTorque(body, -1, [float(hold[0]), float(hold[1]), float(force[2] + hold[2])], 2, client)
        pybullet.stepSimulation(client)


def design_rows(joint: Joint) -> list[dict]:
    """Both designs with gravity along the hinge's axis: error in the plane, what gives out of it, cost."""
    times, exact = reference(joint, SECONDS)
    rows = []
    for dt in (5e-4, 1e-3, 2e-3):
        out: list[float] = []
        theta, spent = swing(joint, dt, "trapezoid", SECONDS, out)
        error, off = errors(theta, dt, times, exact)
        rows.append({"design": "a: joint in the URDF", "dt_ms": 1e3 * dt, "error": error, "frequency_error": off,
                     "sag_mm": 1e3 * out[0], "droop_mrad": 1e3 * out[1],
                     "us_a_step": 1e6 * spent * dt / SECONDS})  # fmt: skip
        body, theta_b, sag, droop = SeparateBody(joint, dt, 9.81), [RELEASE], 0.0, 0.0
        began = time.process_time()
        for k in range(round(SECONDS / dt) + 1):
            body.step()
            if k:
                theta_b.append(body.theta)
            sag, droop = max(sag, abs(body.tip_height)), max(droop, abs(body.droop))
        spent = time.process_time() - began
        pybullet.disconnect(physicsClientId=body.client)
        error, off = errors(np.array(theta_b), dt, times, exact)
        rows.append({"design": "b: separate bodies", "dt_ms": 1e3 * dt, "error": error, "frequency_error": off,
                     "sag_mm": 1e3 * sag, "droop_mrad": 1e3 * droop,
                     "us_a_step": 1e6 * spent * dt / SECONDS})  # fmt: skip
    return rows


def exudyn_swing(joint: Joint, dt: float, seconds: float, modified: bool, elements: int = 8
                 ) -> tuple[np.ndarray, float]:  # fmt: skip
    """Theta at every step and CPU seconds of the dynamic solution: the arm on light ANCF cables, held at 20 deg by the
    same force at its end, let go; implicit trapezoidal rule."""
    import exudyn as exu
    from exudyn.utilities import (
        Cable2D,
        Force,
        GenericJoint,
        MarkerBodyRigid,
        ObjectGround,
        Point2DS1,
        Rigid2D,
        RigidBody2D,
        SensorNode,
    )

    hinge = joint.hinge
    (leaf,) = hinge.leaves
    system = exu.SystemContainer().AddSystem()
    ground = system.AddObject(ObjectGround())
    node = system.AddNode(Rigid2D(referenceCoordinates=[hinge.length + CENTRE, 0, 0]))
    arm = system.AddObject(RigidBody2D(mass=MASS, inertia=INERTIA, nodeNumber=node))
    modulus, area, step = hinge.material.effective_modulus, leaf.width * leaf.thickness, leaf.length / elements
    nodes = [system.AddNode(Point2DS1(referenceCoordinates=[step * i, 0, 1, 0])) for i in range(elements + 1)]
    cables = [system.AddObject(Cable2D(length=step, massPerLength=1e-4, axialStiffness=modulus * area,
                                       bendingStiffness=modulus * area * leaf.thickness**2 / 12,
                                       nodeNumbers=nodes[i : i + 2])) for i in range(elements)]  # fmt: skip
    for body, place, cable, at in ((ground, 0.0, cables[0], 0.0), (arm, -CENTRE, cables[-1], step)):
        on_body = system.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=[place, 0, 0]))
        on_cable = system.AddMarker(MarkerBodyRigid(bodyNumber=cable, localPosition=[at, 0, 0]))
        system.AddObject(GenericJoint(markerNumbers=[on_body, on_cable], constrainedAxes=[1, 1, 0, 0, 0, 1]))
    end = system.AddMarker(MarkerBodyRigid(bodyNumber=arm, localPosition=[0.06, 0, 0]))
    force, _ = arm_state(joint.models["potential"], RELEASE, joint.box.max_force)
    load = system.AddLoad(Force(markerNumber=end, loadVector=[0, force, 0]))
    sensor = system.AddSensor(SensorNode(nodeNumber=node, storeInternal=True,
                                         outputVariableType=exu.OutputVariableType.Coordinates))  # fmt: skip
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.staticSolver.numberOfLoadSteps, settings.staticSolver.verboseMode = 20, 0
    system.SolveStatic(settings, updateInitialValues=True)
    system.SetLoadParameter(load, "loadVector", [0.0, 0.0, 0.0])
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = seconds, round(seconds / dt)
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.newton.useModifiedNewton = modified
    settings.solution.sensors.writePeriod = dt
    began = time.process_time()
    system.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)
    spent = time.process_time() - began
    return np.asarray(system.GetSensorStoredData(sensor))[:, 3], spent


def exudyn_rows(joint: Joint) -> list[dict]:
    """Both in turns, three times, the fastest of each; exudyn with full and with modified Newton."""
    times, exact = reference(joint, SECONDS)
    rows = []
    for dt in (5e-4, 1e-3, 2e-3):
        ours, theirs = [], []
        for _ in range(3):
            ours.append(swing(joint, dt, "trapezoid", SECONDS))
            theirs += [exudyn_swing(joint, dt, SECONDS, modified) for modified in (False, True)]
        own, peer = min(ours, key=lambda run: run[1]), min(theirs, key=lambda run: run[1])
        grid = dt * np.arange(len(peer[0]))
        rows.append({"dt_ms": 1e3 * dt, "ours_ms": 1e3 * own[1], "exudyn_ms": 1e3 * peer[1], "ratio": peer[1] / own[1],
                     "ours_frequency_error": errors(own[0], dt, times, exact)[1],
                     "exudyn_frequency_error": abs(frequency(grid, peer[0]) / frequency(times, exact) - 1),
                     })  # fmt: skip
    return rows


def static_rows(joint: Joint, name: str) -> list[dict]:
    """The stand pulled to 30 places over +-30 deg against the model's own solution at the dynamometer's force."""
    model, worst = joint.models["potential"], np.zeros(2)
    pulled = pull(joint, 30, max_angle=0.999 * joint.box.max_angle)
    for (x, y, theta), force in zip(pulled.poses, pulled.force, strict=True):
        loads = np.array([[0.0, force]])

        def miss(angle: float, loads: np.ndarray = loads) -> float:
            return float(model.poses(np.array([angle]), loads).moment[0] - ARM * loads[0, 1] * np.cos(angle))

        exact = brentq(miss, -joint.box.max_angle, joint.box.max_angle, xtol=1e-15)
        tip = model.poses(np.array([exact]), loads).tip[0]
        worst = np.maximum(worst, [abs(theta - exact), np.hypot(x - tip[0], y - tip[1])])
    return [{"hinge": name, "from_deg": float(np.degrees(pulled.poses[0, 2])),
             "to_deg": float(np.degrees(pulled.poses[-1, 2])), "theta_rad": worst[0], "tip_m": worst[1]}]  # fmt: skip


def ten_seconds(joint: Joint, name: str) -> list[dict]:
    """Energy over 10 s without damping: its largest excess, and the loss a period by the means of the first and last
    second."""
    rows = []
    for dt in (1e-3, 5e-4):
        with FlexibleRobot(packaged_urdf("flexure_stand.urdf"), dt=dt, gravity=(0, 0, 0), fixed_base=True) as robot:
            flexure = FlexureJoint(robot, "hinge", joint)
            _, tip = arm_state(flexure.spring, RELEASE, joint.box.max_force)
            robot.place(robot.place_tip("hinge", [*tip, RELEASE]))
            energy = [robot.energies().total]
            theta = [RELEASE]
            for _ in range(round(10 / dt)):
                robot.step()
                energy.append(robot.energies().total)
                theta.append(flexure.pose[2])
        one = round(1 / dt)
        periods = 9 * frequency(dt * np.arange(len(theta)), np.array(theta))
        first, last = np.mean(energy[:one]), np.mean(energy[-one:])
        rows.append({"hinge": name, "dt_ms": 1e3 * dt, "excess": max(energy) / energy[0] - 1,
                     "lowest": min(energy) / energy[0] - 1,
                     "loss_a_period": (first - last) / energy[0] / periods})  # fmt: skip
    return rows


def show(title: str, rows: list[dict]) -> None:
    names = list(dict.fromkeys(key for row in rows for key in row))
    cells = [[f"{v:.3g}" if isinstance(v := row.get(name, ""), float) else v for name in names] for row in rows]
    print(f"{title}\n{table(names, cells)}\n")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", UserWarning)  # a diverging run leaves the fitted domain, and says so in its row
    joints = {name: fit_joint(preset(name), held_out=0) for name in PAPER_HINGES}
    leaf = joints["leaf-spring"]
    swing(leaf, 1e-3, "trapezoid", 0.01)  # compiles
    tables = {"work-precision: error is RMS over 20 deg in 1 s":
              [row for name in ("leaf-spring", "x-hinge") for row in work_precision(joints[name], name)],
              "static: largest difference to the model's own solution, 30 places":
              [row for name, joint in joints.items() for row in static_rows(joint, name)],
              "10 s without damping": [row for name, joint in joints.items() for row in ten_seconds(joint, name)],
              "designs, gravity along the hinge's axis": design_rows(leaf)}  # fmt: skip
    try:
        tables["1 s of the leaf spring's arm beside exudyn's beam, CPU"] = exudyn_rows(leaf)
    except ImportError:
        print("exudyn is not installed (pip install exudyn): its comparison is left out")
    for title, rows in tables.items():
        show(title, rows)
    if arguments.json:
        arguments.json.write_text(json.dumps(tables, indent=1))


if __name__ == "__main__":
    main()
