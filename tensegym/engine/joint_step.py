"""Ball joints between rods that share a node, as a projected constraint of the leapfrog, compiled.

The forces at the joints are those with which the step, as `rod_rotation.py` takes it, ends with both rods' ends in one
place. Each is the same on both rods, opposite and through one point, midway between the ends, so that it changes no
momentum. This is SHAKE (Ryckaert, Ciccotti, Berendsen 1977), which keeps the leapfrog's lack of drift in energy
(Leimkuhler and Skeel 1994, "Symplectic numerical integrators in constrained Hamiltonian systems"). Newton's matrix is
that of the constraints' mobility, J M^-1 J^T, factored once a step within its profile.
"""

from __future__ import annotations

import numpy as np

from tensegym.compiled import kernel
from tensegym.physics.model import INVERSE_AXIAL, INVERSE_MASS, INVERSE_TRANSVERSE
from tensegym.physics.vectors import KERNEL, cross, dot, turn

from .rod_rotation import leapfrog_turn

_MAX_PASSES, _TOLERANCE = 6, 1e-13  # of Newton's method; m
_SOFT = 1e-12  # of the mobility, added to it: rods braced more than they need share their forces evenly


@kernel(**KERNEL)
def hold_joints(model, state, dt, out):
    """Add the forces at the joints, also written in out.joint_forces, to out.wrenches. From poses, rotations and
    velocities in ``state`` and ``out``, and before the moments are made an engine's."""
    _arms(model, state.poses, out)
    _factor(model, out)
    out.joint_forces[:] = 0.0
    count = 3 * len(model.joint_bodies)
    for _ in range(_MAX_PASSES):
        if _apart(model, state.poses, dt, out) <= _TOLERANCE:
            break
        _solve(model.joint_first, out.joint_matrix, out.joint_apart, count)
        for j in range(len(model.joint_bodies)):
            a, b = model.joint_bodies[j, 0], model.joint_bodies[j, 1]
            at = 3 * j
            x, y, z = out.joint_apart[at], out.joint_apart[at + 1], out.joint_apart[at + 2]
            force = x / (dt * dt), y / (dt * dt), z / (dt * dt)
            on_a, on_b = cross(out.joint_arms[j, 2], force), cross(out.joint_arms[j, 3], force)
            for i in range(3):
                out.joint_forces[j, i] += force[i]
                out.wrenches[a, i] += force[i]
                out.wrenches[b, i] -= force[i]
                out.wrenches[a, 3 + i] += on_a[i]
                out.wrenches[b, 3 + i] -= on_b[i]


@kernel(**KERNEL)
def _arms(model, poses, out):
    """Write what runs from both rods' centres to their ends, then to the middle between those: out.joint_arms."""
    for j in range(len(model.joint_bodies)):
        arms = out.joint_arms[j]
        a, b = model.joint_bodies[j, 0], model.joint_bodies[j, 1]
        for side in range(2):
            turns, at = out.rotations[model.joint_bodies[j, side]], model.joint_points[j, 3 * side : 3 * side + 3]
            for i in range(3):
                arms[side, i] = turns[i, 0] * at[0] + turns[i, 1] * at[1] + turns[i, 2] * at[2]
        for i in range(3):
            gap = (poses[b, i] + arms[1, i]) - (poses[a, i] + arms[0, i])
            arms[2, i], arms[3, i] = arms[0, i] + 0.5 * gap, arms[1, i] - 0.5 * gap


@kernel(**KERNEL)
def _apart(model, poses, dt, out):
    """Write how far apart the step leaves the ends, from a to b: out.joint_apart; returns the largest part [m]."""
    for k in range(len(model.joined)):
        b = model.joined[k]
        params, wrench = model.body_params[b], out.wrenches[b]
        across, along = 1 / params[INVERSE_TRANSVERSE], 1 / params[INVERSE_AXIAL]
        w = out.velocities[b, 3], out.velocities[b, 4], out.velocities[b, 5]
        axis = out.rotations[b, 0, 2], out.rotations[b, 1, 2], out.rotations[b, 2, 2]
        new = leapfrog_turn(w, axis, across, along, dt, wrench[3:])
        for i in range(3):
            out.joint_motion[b, i] = out.velocities[b, i] + dt * params[INVERSE_MASS] * wrench[i]
            out.joint_motion[b, 3 + i] = new[i]
    most = 0.0
    for j in range(len(model.joint_bodies)):
        a, b = model.joint_bodies[j, 0], model.joint_bodies[j, 1]
        one, two, arms = out.joint_motion[a], out.joint_motion[b], out.joint_arms[j]
        end = turn((arms[0, 0], arms[0, 1], arms[0, 2]), (one[3], one[4], one[5]), dt)
        other = turn((arms[1, 0], arms[1, 1], arms[1, 2]), (two[3], two[4], two[5]), dt)
        for i in range(3):
            gap = (poses[b, i] - poses[a, i]) + dt * (two[i] - one[i]) + (other[i] - end[i])
            out.joint_apart[3 * j + i] = gap
            most = max(most, abs(gap))
    return most


@kernel(**KERNEL)
def _factor(model, out):
    """Write Cholesky's factor of the joints' mobility in out.joint_matrix, lower, within its profile."""
    matrix, first = out.joint_matrix, model.joint_first
    joints = model.joint_bodies
    for j in range(len(joints)):
        for k in range(first[j], j + 1):
            for i in range(3):
                for e in range(3):
                    matrix[3 * j + i, 3 * k + e] = 0.0
            for side in range(2):
                for other in range(2):
                    if joints[j, side] == joints[k, other]:
                        sign = 1.0 if side == other else -1.0
                        block = matrix[3 * j : 3 * j + 3, 3 * k : 3 * k + 3]
                        arm, lever = out.joint_arms[j, 2 + side], out.joint_arms[k, 2 + other]
                        _add_block(model, out, joints[j, side], sign, arm, lever, block)
        for i in range(3):
            matrix[3 * j + i, 3 * j + i] *= 1 + _SOFT
    for r in range(3 * len(joints)):
        start = 3 * first[r // 3]
        for c in range(start, r + 1):
            total = matrix[r, c]
            for k in range(max(start, 3 * first[c // 3]), c):
                total -= matrix[r, k] * matrix[c, k]
            matrix[r, c] = np.sqrt(max(total, _SOFT * matrix[r, r])) if c == r else total / matrix[c, c]


@kernel(**KERNEL)
def _add_block(model, out, body, sign, arm, lever, block):
    """Add to a block (3, 3) what a unit force at ``lever`` (3,) of a body does to the velocity at ``arm`` (3,)."""
    params = model.body_params[body]
    across, more = params[INVERSE_TRANSVERSE], params[INVERSE_AXIAL] - params[INVERSE_TRANSVERSE]
    axis = out.rotations[body, 0, 2], out.rotations[body, 1, 2], out.rotations[body, 2, 2]
    for e in range(3):
        unit = 1.0 * (e == 0), 1.0 * (e == 1), 1.0 * (e == 2)
        moment = cross(lever, unit)
        part = more * dot(moment, axis)
        spin = (across * moment[0] + part * axis[0], across * moment[1] + part * axis[1],
                across * moment[2] + part * axis[2])  # fmt: skip
        speed = cross(spin, arm)
        for i in range(3):
            block[i, e] += sign * (params[INVERSE_MASS] * unit[i] + speed[i])


@kernel(**KERNEL)
def _solve(first, factor, right, count):
    """Replace right (count,) by the solution of factor factor^T x = right."""
    for r in range(count):
        total = right[r]
        for k in range(3 * first[r // 3], r):
            total -= factor[r, k] * right[k]
        right[r] = total / factor[r, r]
    for r in range(count - 1, -1, -1):
        right[r] /= factor[r, r]
        for k in range(3 * first[r // 3], r):
            right[k] -= factor[r, k] * right[r]
