"""The substep loop in compiled code from end to end: states out of the engine, the force kernel, forces in, the step.

What `World.read`, the kernel and `World.step` do in turn, and to the same bits.
"""

from __future__ import annotations

from numba import njit

from tensegym.bullet.c_interface import client_handle, push_and_step, read_states
from tensegym.physics.substep import substep


@njit(cache=True)
def run(count, client, total, window, bodies, pinned, poses, angles, wrenches, *arguments):
    """Take ``count`` time steps of a DIRECT client that holds ``total`` bodies; returns how many were taken.

    window as `state_window` finds it; bodies (b,) are their numbers, pinned (p,) rows of those with two links;
    ``arguments`` are the kernel's after ``wrenches``. Fewer steps than asked for mean that the client, or a body in it,
    is gone.
    """
    handle = client_handle(client, total)
    if handle == 0:
        return 0
    for done in range(count):
        if not read_states(handle, window, bodies, pinned, poses, angles):
            return done
        substep(poses, angles, wrenches, *arguments)
        push_and_step(handle, bodies, pinned, poses, wrenches)
    return count
