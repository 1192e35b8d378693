"""A body that nothing turns: Kane's solution for one that is symmetric about its axis, drift of one that is not.

With moments I across the axis and J along it, the axis goes round the angular momentum H at |H| / I, and the body turns
about the axis by w_z (I - J) / I more: Kane, Likins and Levinson, Spacecraft Dynamics, 3.1; Drake's free_body.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.design.bodies import design_bodies
from tensegym.design.design import RobotDesign
from tensegym.validation.free_bodies import FreeBodies, body
from tensegym.validation.row import Findings, Row

STEPS = (4e-3, 2e-3, 1e-3, 0.5e-3)


def exact(inertia: tuple[float, float, float], spin: FloatArray, time: float) -> tuple[FloatArray, FloatArray]:
    """Orientation xyzw and angular velocity in the world after ``time`` [s], from the identity and ``spin`` (3,)."""
    across, _, along = inertia
    momentum = np.array([across, across, along]) * spin
    precession = Rotation.from_rotvec(time * momentum / across)
    turn = precession * Rotation.from_rotvec([0, 0, time * spin[2] * (across - along) / across])
    return turn.as_quat(), precession.apply(spin)


def fly(engine: str, inertia: tuple[float, float, float], mass: float, spin: FloatArray, dt: float,
        seconds: float) -> tuple[float, float, float, float]:  # fmt: skip
    """Angle between the axis and the exact one [rad] after ``seconds``; relative change since the first step of the
    spin about it, of the angular momentum and of the energy."""
    with FreeBodies(engine, [body("free", mass, inertia)], dt) as free:
        early = exact(inertia, spin, -dt / 2)[1]
        free.start(np.array([[0, 0, 5, 0, 0, 0, 1.0]]), np.concatenate([[0, 0, 0], early])[None])
        free.run(1)
        first = _kept(free, np.array(inertia))
        free.run(round(seconds / dt) - 1)
        changes = _kept(free, np.array(inertia)) / first - 1
        axis = Rotation.from_quat(free.poses[0, 3:]).apply([0, 0, 1])
    off = np.linalg.norm(axis - Rotation.from_quat(exact(inertia, spin, seconds)[0]).apply([0, 0, 1]))
    return float(2 * np.arcsin(off / 2)), float(changes[0]), float(changes[1]), float(changes[2])


def _kept(free: FreeBodies, inertia: FloatArray) -> FloatArray:
    """(3,) spin about z, size of the angular momentum, energy of turning: half a step ago, where velocities live."""
    w = free.velocities[0, 3:]
    local = (Rotation.from_rotvec(free.dt / 2 * w) * Rotation.from_quat(free.state.last_poses[0, 3:])).inv().apply(w)
    return np.array([local[2], np.linalg.norm(inertia * local), inertia @ local**2 / 2])


def kane(engine: str) -> Findings:
    """Drake's body, and the hard case, a rod of the robot, J / I near 1e-3, tumbling and spinning fast."""
    rod = design_bodies(RobotDesign())[0].link
    cases = {"J / I = 0.5": ((0.04, 0.04, 0.02), 1.0, np.array([2.0, -4.0, 7.0])),
             f"a rod, J / I = {rod.inertia[2] / rod.inertia[0]:.2g}": (rod.inertia, rod.mass,
                                                                      np.array([8.0, 3.0, 20.0]))}  # fmt: skip
    rows, curves = [], {}
    for name, (inertia, mass, spin) in cases.items():
        errors = [fly(engine, inertia, mass, spin, dt, 2.0) for dt in STEPS]
        angle, turn, momentum, energy = errors[STEPS.index(1e-3)]
        order = float(np.polyfit(np.log(STEPS), np.log([error[0] for error in errors]), 1)[0])
        rows += [Row("kane", f"{name}: axis off after 2 s, rad", 0.0, angle, 2e-3, 1e-3),
                 Row("kane", f"{name}: order of that in the time step", 2.0, order, 0.1),
                 Row("kane", f"{name}: spin about the axis, relative change", 0.0, turn, 1e-6, 1e-3),
                 Row("kane", f"{name}: angular momentum, relative change", 0.0, momentum, 1e-6, 1e-3),
                 Row("kane", f"{name}: energy, relative change", 0.0, energy, 1e-6, 1e-3)]  # fmt: skip
        curves[name] = [error[0] for error in errors]
    return Findings(rows, {"time step, s": STEPS, "axis off after 2 s, rad": curves})


def boxes(engine: str) -> Findings:
    """A box of 1 x 4 x 9, which is symmetric about no axis, spun about its longest and its middle axis, by the engine
    alone: no robot here has such a body, and nothing mends its turning."""
    sides = np.array([1.0, 4.0, 9.0]) / 10
    inertia = (sides @ sides - sides**2) / 12
    start = {"stable, about the longest axis": np.array([0.01, 0.01, 6.0]),
             "unstable, about the middle axis": np.array([0.01, 6.0, 0.01])}  # fmt: skip
    rows, curves = [], {}
    for name, spin in start.items():
        drifts = np.array([_drift(engine, inertia, spin, dt, 10.0) for dt in STEPS])
        momentum, energy = drifts[STEPS.index(1e-3)]
        order = float(np.polyfit(np.log(STEPS), np.log(drifts[:, 0]), 1)[0])
        rows += [Row("boxes", f"{name}: order of the drift of momentum in the time step", 1.0, order, 0.3),
                 Row("boxes", f"{name}: angular momentum, relative drift in 10 s", 0.0, float(momentum), 1e-2, 1e-3),
                 Row("boxes", f"{name}: energy, relative drift in 10 s", 0.0, float(energy), 1e-2, 1e-3)]  # fmt: skip
        curves[name] = drifts[:, 0].tolist()
    return Findings(rows, {"time step, s": STEPS, "drift of momentum in 10 s": curves})


def _drift(engine: str, inertia: FloatArray, spin: FloatArray, dt: float, seconds: float) -> tuple[float, float]:
    x, y, z = inertia.tolist()
    with FreeBodies(engine, [body("box", 1.0, (x, y, z))], dt) as free:
        free.start(np.array([[0, 0, 5, 0, 0, 0, 1.0]]), np.concatenate([[0, 0, 0], spin])[None])
        kept = []
        for _ in range(round(seconds / dt)):
            free.step(np.zeros((1, 6)))
            kept.append(_kept(free, inertia)[1:])
    drifts = np.abs(np.array(kept) / kept[0] - 1).max(axis=0)
    return float(drifts[0]), float(drifts[1])
