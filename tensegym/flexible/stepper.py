"""Stepper: a loaded robot's state as the engine has it, and its time step."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.bullet import Articulated
from tensegym.errors import SimulationError

from . import contacts, step_kernel
from .load import Load
from .springs import Springs
from .tree import Tree

Scheme = Literal["trapezoid", "linear", "explicit"]
SCHEMES = {"trapezoid": (step_kernel.TRAPEZOID, step_kernel.MOST_ITERATIONS), "linear": (step_kernel.TRAPEZOID, 1),
           "explicit": (step_kernel.EXPLICIT, 1)}  # fmt: skip
SPEED_BOUND = 1e5  # m/s or rad/s
Pushes = list[tuple[int, list[float], list[float], list[float]]]


class Stepper:
    """Finds the forces of a step (step_kernel.py), gives them to the engine and reads what came of it.

    The engine's velocities are half a step before its positions, as its leapfrog and the trapezoidal step count them.
    ``torques`` (j,) act on the moving joints; ``loads`` come with the rows of their links.
    """

    def __init__(self, body: Articulated, ground: int | None, tree: Tree, springs: Springs, gravity: FloatArray,
                 friction: float, dt: float, scheme: Scheme) -> None:  # fmt: skip
        self.body, self.ground, self.tree, self.springs = body, ground, tree, springs
        self.gravity, self.friction, self.dt, self.scheme = gravity, friction, dt, scheme
        count = len(body.moving)
        self.time = 0.0
        self.base = np.empty(7)
        """(7,) position and quaternion xyzw of the base's principal frame."""
        self.positions = np.zeros(count)
        """(j,) of the moving joints."""
        self.speeds = np.zeros(tree.first + count)
        """(n,) velocity of the base (6, floating only) and joint rates."""
        self.margins = np.ones(len(springs.kind))
        """(f,) of every flexure at the beginning of the last step, see spring_kernel.margin."""
        self._drag = np.array([body.joint_info[i][6] for i in body.moving], dtype=float)
        self._acceleration, self._force = np.zeros_like(self.speeds), np.zeros_like(self.speeds)

    def start(self, torques: FloatArray, loads: Sequence[tuple[int, Load]]) -> None:
        """Put the engine where ``base``, ``positions`` and ``speeds`` are, these taken at the time of the positions."""
        asked, first = self.speeds.copy(), self.tree.first
        self.time, self._acceleration[:] = 0.0, 0.0
        # placed before it is solved for: contacts are looked for where the engine has the body
        self.body.place(self.base.tolist(), (0.0,) * 6, self.positions, np.zeros(len(self.positions)))
        if self.scheme != "explicit":
            for _ in range(3):  # the springs' own share cancels: it converges at once but for the velocity terms
                self._solve(torques, loads)
                self.speeds[:] = asked - 0.5 * self.dt * self._acceleration
        twist = self.speeds[:6] if first else np.zeros(6)
        self.body.place(self.base.tolist(), twist.tolist(), self.positions, self.speeds[first:])

    def velocities(self, torques: FloatArray, loads: Sequence[tuple[int, Load]]) -> FloatArray:
        """(n,) ``speeds`` at the time of the positions."""
        if self.scheme == "explicit":
            return self.speeds.copy()
        kept = self._acceleration.copy()
        self._solve(torques, loads)
        now = self.speeds + 0.5 * self.dt * self._acceleration
        self._acceleration[:] = kept
        return now

    def step(self, torques: FloatArray, loads: Sequence[tuple[int, Load]]) -> None:
        """Advance one time step.

        Raises SimulationError when its forces cannot be found or the state is no longer finite.
        """
        body, first = self.body, self.tree.first
        for link, force, place, torque in self._solve(torques, loads):
            body.push_link(link - 1, force, place, torque)
        if first:
            own = self._force[:6].tolist()
            body.push_link(-1, own[:3], self.base[:3].tolist(), own[3:])
        body.push_joints((self._force[first:] + torques).tolist())
        body.world.advance()
        self.time += self.dt
        body.read_joints(self.positions, self.speeds[first:])
        if first:
            body.read_base(self.base, self.speeds[:6])
        if not np.isfinite(self.speeds).all() or np.abs(self.speeds).max() > SPEED_BOUND:
            raise SimulationError(f"the motion diverged at t = {self.time:.4g} s; take a shorter time step")

    def _solve(self, torques: FloatArray, loads: Sequence[tuple[int, Load]]) -> Pushes:
        """Find the forces and the acceleration of the next step; returns the loads as the engine takes them."""
        known = np.zeros(len(self.speeds))
        known[self.tree.first :] = torques
        pushes = []
        for row, load in loads:
            force, point, torque = (np.array(part, float) for part in (load.force, load.point, load.torque))
            place = step_kernel.add_load(self.tree, self.base, self.positions, row, force, point, torque, known)
            pushes.append((row, force.tolist(), place.tolist(), torque.tolist()))
        points = [] if self.ground is None else contacts.candidates(
            self.body, self.ground, self.tree, self.base, self.positions, len(known)
        )  # fmt: skip
        weight = contacts.WEIGHT * float(self.tree.mass.sum())
        kind, most = SCHEMES[self.scheme]
        for _ in range(contacts.PASSES):
            hold, stop = contacts.holds(points, self.speeds, self.dt, weight)
            done = step_kernel.step_forces(
                self.tree, self.springs, self.base, self.positions, self.speeds, known, self._drag, hold, stop,
                self.gravity, self.dt, kind, most, self._acceleration, self._force, self.margins,
            )  # fmt: skip
            if done < 0 or not contacts.revise(
                points, self.speeds, self._acceleration, self.dt, weight, self.friction
            ):  # fmt: skip
                break
        if done < 0:
            raise SimulationError(f"no forces found for the step at t = {self.time:.4g} s; take a shorter time step")
        return pushes
