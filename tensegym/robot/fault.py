"""Which element of a robot has gained the energy, told where a simulation diverges or breaks its energy audit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tensegym.physics.model import STIFFNESS, TWO_WAY
from tensegym.physics.vectors import z_axis

if TYPE_CHECKING:
    from .robot_state import RobotState


def cable_name(robot: RobotState, row: int) -> str:
    """Of the cable in this row of the robot's cables, by its nodes or its rod, counted from 1."""
    structure = robot.design.structure
    pairs = np.concatenate([structure.cables, structure.stiff_cables])
    if row >= len(pairs):
        return f"the payload's cable of rod {'-'.join(map(str, structure.rods[row - len(pairs)] + 1))}"
    return f"{'cable' if row < len(structure.cables) else 'stiff cable'} {'-'.join(map(str, pairs[row] + 1))}"


def element_energies(robot: RobotState) -> dict[str, float]:
    """Kinetic energy of every body by the way that it moves, elastic energy of every cable and flexure [J]."""
    model, velocities, poses = robot.model, robot.velocities_in_world(), robot.poses_in_world
    rods, found = robot.design.structure.rods, dict[str, float]()
    names = ["rod " + "-".join(map(str, rod + 1)) for rod in rods]
    names += ["the payload"] if robot.design.payload else []
    names += [names[int(model.other_half[body])] for body in range(len(names), len(poses))]
    for body, name in enumerate(names):
        v, w, axis = velocities[body, :3], velocities[body, 3:], np.array(z_axis(poses[body, 3:]))
        spin, (across, _, along) = float(w @ axis), model.inertias[body]
        for way, energy in (("motion", model.masses[body] * (v @ v)), ("spin", along * spin**2),
                            ("tumbling", across * (w @ w - spin**2))):  # fmt: skip
            key = f"the {way} of {name}"
            found[key] = found.get(key, 0.0) + 0.5 * float(energy)
    stretch, params = robot.lengths - robot.natural_lengths, model.spring_params[: model.first_flexure]
    held = np.where((stretch > 0) | (params[:, TWO_WAY] == 1), 0.5 * params[:, STIFFNESS] * stretch**2, 0.0)
    found |= {f"the stretch of {cable_name(robot, row)}": float(energy) for row, energy in enumerate(held)}
    bends = 0.5 * model.spring_params[model.first_flexure :, STIFFNESS] * robot.flexure_angles**2
    names = [f"the bend of rod {'-'.join(map(str, rods[rod] + 1))}" for rod in robot.design.flexible_rods]
    return found | dict(zip(names, bends.tolist(), strict=True))


def most_gained(robot: RobotState, start: dict[str, float] | None = None) -> str:
    """The element with the most energy over that at the start; what is no number counts as most. A drive that has wound
    in more than its cable is named before."""
    natural = robot.natural_lengths[robot.model.driven]
    if (natural <= 0).any():
        row = robot.model.first_driven + int(natural.argmin())
        return f"the drive of {cable_name(robot, row)}, which has wound in more than the cable"
    with np.errstate(over="ignore", invalid="ignore"):
        gains = {name: energy - (start or {}).get(name, 0.0) for name, energy in element_energies(robot).items()}
    gains = {name: gain if np.isfinite(gain) else np.inf for name, gain in gains.items()}
    name = max(gains, key=lambda key: gains[key])
    return name if np.isinf(gains[name]) else f"{name}, {gains[name]:.3g} J"


def divergence(robot: RobotState) -> str:
    """One line on a robot whose simulation has diverged."""
    rates = np.nan_to_num(np.abs(robot.rates), nan=np.inf)
    cable = cable_name(robot, int(rates.argmax())) if len(rates) else "no cable"
    return (f"diverged at t = {robot.time:.4g} s: {cable} changes length at {rates.max(initial=0.0):.3g} m/s, most "
            f"energy in {most_gained(robot)}; lower dt = {robot.dt:g} s")  # fmt: skip
