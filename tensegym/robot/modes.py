"""Free modes of a whole design: what the force law itself does about the standing robot.

Coordinates are those of the bodies: six of a whole one, seven of a split rod (`tensegym.physics.tangent`). Prestress,
attachment radius, flexures and payload are in the stiffness; stiff cables, slack at rest, are left out, and so is all
damping. `tensegym.structure.modes.free_modes` is the closed form for plain rods.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from tensegym.design.design import RobotDesign
from tensegym.physics.geometry import points_at
from tensegym.physics.joints import joint_tangent
from tensegym.physics.model import STIFFNESS
from tensegym.physics.robot_arrays import robot_model
from tensegym.physics.step_limit import standing
from tensegym.physics.tangent import STEP, moved, tangent
from tensegym.structure.modes import Modes


def design_modes(design: RobotDesign) -> Modes:
    """Modes of a design in free flight, the six rigid motions left out; shapes are displacements of the nodes.

    Frequencies of motions that nothing holds, such as the spin of rods whose cables end on the axis, are 0. An unstable
    motion shows as NaN.
    """
    model = robot_model(design)
    rest = standing(model)
    at = tangent(model, *rest)
    held = model.spring_params[:, STIFFNESS] * (rest.tensions != 0)
    held[model.first_flexure :] = model.spring_params[model.first_flexure :, STIFFNESS]
    joints = joint_tangent(model, at, rest.poses, rest.tensions)
    stiffness = at.geometric + joints.geometric + at.rates.T @ (held[:, None] * at.rates)
    size = len(stiffness)
    points = np.empty((size, len(model.node_bodies), 3))
    for column in range(size):
        ahead, back = (points_at(moved(model, rest.poses, rest.angles, column, by)[0], model.node_bodies,
                                 model.node_points) for by in (STEP, -STEP))  # fmt: skip
        points[column] = (ahead - back) / (2 * STEP)
    free = joints.free
    values, vectors = eigh(free.T @ stiffness @ free, free.T @ at.mass @ free)
    vectors = free @ vectors
    elastic = np.sort(np.argsort(np.abs(values))[6:])
    with np.errstate(invalid="ignore"):
        zero = np.abs(values[elastic]) < 1e-6 * values[-1]
        frequencies = np.where(zero, 0.0, np.sqrt(values[elastic])) / (2 * np.pi)
    return Modes(frequencies, np.einsum("cni,ck->kni", points, vectors[:, elastic]))
