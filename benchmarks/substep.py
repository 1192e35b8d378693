"""The substep of a rolling robot beside the engine's own step, in MuJoCo, as a Python cable loop and by MuJoCo alone.

The robot rolls under random commands, and all step the same motion: ours in the compiled loop; the engine's own step on
the recorded forces of that block, from its saved start; the reference loop in Python; MuJoCo alone from where the
robot stands. Seconds are those of this thread's processor time, which other programs on the machine do not add to.
"""

from __future__ import annotations

import time
from collections.abc import Iterator

import mujoco
import numpy as np
import pybullet
from numba import njit
from timing import OneCore, Row, in_turn, row

from tensegym.bullet.c_interface import client_handle, push_and_step
from tensegym.design.design import Payload, RobotDesign
from tensegym.mujoco.robot_mjcf import robot_mjcf
from tensegym.physics.model import DAMPING, END_A, END_B, STIFFNESS
from tensegym.robot.robot import TensegrityRobot

BLOCK = 100  # substeps


@njit
def _replay(engine, poses, wrenches):
    handle = client_handle(engine.client, engine.body_count)
    for i in range(len(poses)):
        push_and_step(handle, engine.body_ids, engine.two_link_rows, poses[i], wrenches[i])


class Rolling:
    """Contestants on one motion: each method steps a block and returns its microseconds a substep."""

    def __init__(self, design: RobotDesign, dt: float) -> None:
        self.ours = TensegrityRobot(design, dt=dt)
        self.reference = TensegrityRobot(design, dt=dt, compiled=False)
        self.naive_robot = TensegrityRobot(design, dt=1e-3)
        self.rng = np.random.default_rng(0)
        for robot in (self.ours, self.reference):
            robot.reset(0)
            robot.step(500)
        self.poses = np.zeros((BLOCK, *self.ours.world.poses.shape))
        self.wrenches = np.zeros((BLOCK, len(self.ours.world.poses), 6))
        _replay(self.reference.world.hand_over()._replace(client=-1), self.poses[:0], self.wrenches[:0])  # compiles it

    def close(self) -> None:
        for robot in (self.ours, self.reference, self.naive_robot):
            robot.close()

    def substep(self) -> float:
        self.commands = self.rng.uniform(0, 1, len(self.ours.drives)) * self.ours.command_limit
        self.ours.command(self.commands)
        self.reference.command(self.commands)
        began = time.thread_time()
        self.ours.step(BLOCK)
        return (time.thread_time() - began) / BLOCK * 1e6

    def python_loop(self) -> float:
        """The reference path, and on the way what `bare_step` replays."""
        world, state = self.reference.world, self.reference.world.save()
        spent = 0.0
        for i in range(BLOCK):
            began = time.thread_time()
            self.reference.step()
            spent += time.thread_time() - began
            self.poses[i], self.wrenches[i] = world.poses, self.reference._out.wrenches
        end = world.save()
        world.restore(state)
        self.bare = self._replayed()
        world.restore(end)
        for kept in (state, end):
            pybullet.removeState(kept, physicsClientId=world.client)
        return spent / BLOCK * 1e6

    def _replayed(self) -> float:
        engine = self.reference.world.hand_over()
        began = time.thread_time()
        _replay(engine, self.poses, self.wrenches)
        return time.thread_time() - began

    def bare_step(self) -> float:
        """stepSimulation and the forces that make the motion the same (some 0.4 us of it)."""
        return self.bare / BLOCK * 1e6

    def naive(self) -> float:
        """The obvious way at 1 ms, from where ours stands: a Python loop over cables, two forces each, end points by
        multiplyTransforms."""
        robot = self.naive_robot
        world, model, client = robot.world, robot.model, robot.world.client
        world.place(self.ours.poses_in_world, self.ours.velocities_in_world())
        natural, last = self.ours.natural_lengths.copy(), self.ours.lengths.copy()
        began = time.thread_time()
        for _ in range(BLOCK):
            poses = [pybullet.getBasePositionAndOrientation(body, client) for body in world.body_ids]
            for c, (a, b) in enumerate(model.spring_bodies):
                params = model.spring_params[c]
                pa, _ = pybullet.multiplyTransforms(*poses[a], params[END_A].tolist(), [0, 0, 0, 1])
                pb, _ = pybullet.multiplyTransforms(*poses[b], params[END_B].tolist(), [0, 0, 0, 1])
                span = np.subtract(pb, pa)
                length = np.linalg.norm(span)
                stretch, rate = length - natural[c], (length - last[c]) / robot.dt
                tension = max(0.0, params[STIFFNESS] * stretch + params[DAMPING] * rate) if stretch > 0 else 0.0
                last[c] = length
                force = tension / length * span
                pybullet.applyExternalForce(world.body_ids[a], -1, force, pa, pybullet.WORLD_FRAME, client)
                pybullet.applyExternalForce(world.body_ids[b], -1, -force, pb, pybullet.WORLD_FRAME, client)
            pybullet.stepSimulation(client)
        return (time.thread_time() - began) / BLOCK * 1e6


class InMujoco:
    """Our robot in MuJoCo, and MuJoCo alone with the robot as `tensegym export` writes it, from where ours stands."""

    def __init__(self, rolling: Rolling, design: RobotDesign, dt: float) -> None:
        self.rolling = rolling
        self.robot = TensegrityRobot(design, dt=dt, engine="mujoco")
        self.model = mujoco.MjModel.from_xml_string(robot_mjcf(design, dt=dt, integrator="Euler"))
        self.data = mujoco.MjData(self.model)

    def substep(self) -> float:
        self.robot.command(self.rolling.commands)
        began = time.thread_time()
        self.robot.step(BLOCK)
        return (time.thread_time() - began) / BLOCK * 1e6

    def alone(self) -> float:
        ours, coordinates = self.rolling.ours, self.data.qpos.reshape(-1, 7)
        mujoco.mj_resetData(self.model, self.data)
        coordinates[:, :3] = ours.poses_in_world[:, :3]
        coordinates[:, 3:] = np.roll(ours.poses_in_world[:, 3:], 1, axis=1)
        self.data.ctrl[:] = (ours.model.rest_lengths[: len(ours.lengths)] - ours.natural_lengths)[ours.model.driven]
        began = time.thread_time()
        mujoco.mj_step(self.model, self.data, nstep=BLOCK)
        return (time.thread_time() - began) / BLOCK * 1e6


CASES = (("1 ms explicit", RobotDesign(), 1e-3), ("2 ms implicit", RobotDesign(), 2e-3),
         ("1 ms, payload", RobotDesign(payload=Payload()), 1e-3),
         ("2 ms, payload", RobotDesign(payload=Payload()), 2e-3))  # fmt: skip


def rows(rounds: int) -> Iterator[Row]:
    """Ratios of the substep on one core, case by case; the naive loop and MuJoCo alone are of 1 ms."""
    with OneCore():
        for name, design, dt in CASES:
            yield from _case(name, design, dt, rounds)


def _case(name: str, design: RobotDesign, dt: float, rounds: int) -> Iterator[Row]:
    unit, rolling = "us", Rolling(design, dt)
    other = InMujoco(rolling, design, dt)
    contestants = {"substep": rolling.substep, "python": rolling.python_loop, "bare": rolling.bare_step}
    others = {"substep": rolling.substep, "in MuJoCo": other.substep}  # in turns of their own: each takes the cache
    if dt == 1e-3:
        contestants["naive"] = rolling.naive
        others["MuJoCo"] = other.alone
    try:
        seen, beside = in_turn(contestants, rounds), in_turn(others, rounds)
    finally:
        rolling.close()
        other.robot.close()
    yield row(f"substep, {name} / bare stepSimulation", seen["substep"], seen["bare"], unit, 2.0)
    yield row(f"Python calls around the kernel / substep, {name}", seen["python"], seen["substep"], unit)
    yield row(f"substep in MuJoCo / in PyBullet, {name}", beside["in MuJoCo"], beside["substep"], unit)
    if dt == 1e-3:
        yield row(f"naive Python loop / substep, {name}", seen["naive"], seen["substep"], unit, 10, at_least=True)
        yield row(f"substep, {name} / Euler step of MuJoCo alone", beside["substep"], beside["MuJoCo"], unit, 1.4)
