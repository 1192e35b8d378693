"""How fast bodies move, and the damping of their spin about their own axes, compiled."""

from __future__ import annotations

from tensegym.compiled import kernel

from .model import SPIN_DAMPING
from .vectors import KERNEL, angular_velocity, dot


@kernel(**KERNEL)
def damp_spins(params, poses, last_poses, dt, rotations, velocities, wrenches):
    """Write velocities (b, 6), those over the last step, and add the damping of the spins to wrenches (b, 6).

    params (b, 4), poses (b, 7), last_poses (b, 7), rotations (b, 3, 3): the Model's, the State's and the Out's.
    """
    for b in range(len(poses)):
        w = angular_velocity(poses[b], last_poses[b], dt)
        axis = rotations[b, 0, 2], rotations[b, 1, 2], rotations[b, 2, 2]
        spin = dot(w, axis)
        for i in range(3):
            velocities[b, i], velocities[b, 3 + i] = (poses[b, i] - last_poses[b, i]) / dt, w[i]
            wrenches[b, 3 + i] -= params[b, SPIN_DAMPING] * spin * axis[i]
