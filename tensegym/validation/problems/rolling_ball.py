"""Balls that slide and roll: a bowling ball, and 25 balls on a box that is pushed."""

from __future__ import annotations

import numpy as np

from tensegym.design.bodies import Shape
from tensegym.validation.free_bodies import FreeBodies, body
from tensegym.validation.row import Findings, Row

RADIUS, MASS, INERTIA, FRICTION, GRAVITY = 0.10795, 6.35, 0.0296, 0.12, 9.8  # Drake's bowling_ball
SPEED, SPIN = 8.0, 8 * np.pi  # along y and about y


def bowling(engine: str, dt: float = 1e-3) -> Findings:
    """A ball thrown along y with a spin about y slides until what touches the ground stands still, then rolls.

    The point that touches starts with u = (-r w, v) and is slowed along itself by mu g (1 + m r^2 / I); the velocity of
    the centre loses mu g t along u. Drake's bowling_ball benchmark.
    """
    slowing = FRICTION * GRAVITY * (1 + MASS * RADIUS**2 / INERTIA)
    contact = np.array([-RADIUS * SPIN, SPEED])
    rolls = np.linalg.norm(contact) / slowing
    final = np.array([0, SPEED]) - FRICTION * GRAVITY * rolls * contact / np.linalg.norm(contact)
    times, slip = [], []
    with FreeBodies(engine, [body("ball", MASS, [INERTIA] * 3, Shape("sphere", (RADIUS,)))], dt, FRICTION,
                    GRAVITY) as ball:  # fmt: skip
        ball.start(np.array([[0, 0, RADIUS, 0, 0, 0, 1.0]]), np.array([[0, SPEED, 0, 0, SPIN, 0]]))
        for step in range(round(2.4 / dt)):
            ball.step(np.zeros((1, 6)))
            v = ball.velocities[0]
            times.append((step + 0.5) * dt)
            slip.append(np.hypot(v[0] - RADIUS * v[4], v[1] + RADIUS * v[3]))
    stopped = next((t for t, s in zip(times, slip, strict=True) if s < slowing * dt), np.inf)
    rows = [Row("bowling", "rolling begins, s", float(rolls), stopped, 2 * dt, dt)]
    rows += [Row("bowling", f"velocity along {axis} when it rolls, m/s", float(final[i]), float(v[i]), 2e-3, dt)
             for i, axis in enumerate("xy")]  # fmt: skip
    every = slice(None, None, max(1, len(times) // 60))
    line = [max(0.0, float(np.linalg.norm(contact) - slowing * t)) for t in times]
    return Findings(rows, {"time, s": times[every], "measured, m/s": slip[every], "exact, m/s": line[every]})


def pushed_box(engine: str, dt: float = 1e-3, seconds: float = 1.0, balls: int = 5) -> Findings:
    """A box of 10 kg, with 25 balls of 1 kg on it, is pushed over the ground by 150 N along x + y.

    The box slides, mu (M + n m) g holding it; the balls roll on it without sliding, each taking f = m a_ball, so that
    a_ball = 2/7 a_box. SimBenchmark (ETH Zurich), its rolling test; there mu is 0.4 on the ground and 0.8 on the box,
    here 0.4 on both, which the answer does not ask about.
    """
    box_mass, mass, mu, g, force, radius = 10.0, 1.0, 0.4, 9.81, 150.0, 0.5
    count = balls**2
    box = (force - mu * (box_mass + count * mass) * g) / (box_mass + count * mass / 3.5)
    side, height = 20.0, 1.0
    flat = box_mass / 12 * (side**2 + height**2), box_mass / 12 * (side**2 + height**2), box_mass / 6 * side**2
    bodies = [body("box", box_mass, flat, Shape("box", (side, side, height)))]
    bodies += [body("ball", mass, [0.4 * mass * radius**2] * 3, Shape("sphere", (radius,)))] * count
    places = 2.0 * (np.arange(balls) - (balls - 1) / 2)
    poses = np.zeros((1 + count, 7))
    poses[:, 6], poses[0, 2] = 1.0, height / 2
    poses[1:, :2], poses[1:, 2] = np.array(np.meshgrid(places, places)).reshape(2, -1).T, height + radius
    push = np.zeros((1 + count, 6))
    push[0, :2] = force / np.sqrt(2)
    speeds = []
    with FreeBodies(engine, bodies, dt, mu, g) as free:
        free.start(poses, np.zeros((1 + count, 6)))
        for _ in range(round(seconds / dt)):
            free.step(push)
            v = free.velocities
            speeds.append([v[0, :2].sum() / np.sqrt(2), v[1:, :2].sum(axis=1).mean() / np.sqrt(2)])
    late = np.array(speeds)[len(speeds) // 4 :]  # the first contacts have been made
    found = np.polyfit(dt * np.arange(len(late)), late, 1)[0]
    return Findings([
        Row("pushed", "acceleration of the box, m/s^2", box, float(found[0]), 1e-3 * box, dt),
        Row("pushed", "of the balls, m/s^2", box / 3.5, float(found[1]), 1e-3 * box / 3.5, dt),
    ])  # fmt: skip
