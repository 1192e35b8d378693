"""How fast bodies move, and the damping of their spin about their own axes, compiled."""

from __future__ import annotations

from tensegym.compiled import kernel

from .model import SPIN_DAMPING
from .vectors import KERNEL, angular_velocity, dot


@kernel(**KERNEL)
def damp_spins(model, state, dt, out):
    """Write out.velocities, those over the last step, and add the damping of the spins to out.wrenches."""
    poses, last_poses, velocities = state.poses, state.last_poses, out.velocities
    for b in range(len(poses)):
        w = angular_velocity(poses[b], last_poses[b], dt)
        axis = out.rotations[b, 0, 2], out.rotations[b, 1, 2], out.rotations[b, 2, 2]
        spin = dot(w, axis)
        for i in range(3):
            velocities[b, i], velocities[b, 3 + i] = (poses[b, i] - last_poses[b, i]) / dt, w[i]
            out.wrenches[b, 3 + i] -= model.body_params[b, SPIN_DAMPING] * spin * axis[i]
