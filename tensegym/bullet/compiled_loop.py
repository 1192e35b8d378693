"""The substep loop in compiled code from end to end: states out of the engine, the force kernel, forces in, the step.

What `World.run` does in turn in Python, and to the same bits.
"""

from __future__ import annotations

from tensegym.compiled import kernel
from tensegym.engine.leapfrog import engine_substep
from tensegym.physics.vectors import ALLOCATING

from .c_interface import client_handle, push_and_step, read_states


@kernel(**ALLOCATING)
def run(count, engine, model, ground, state, out, dt, implicit):
    """Take ``count`` time steps of a DIRECT client; returns how many were taken.

    engine: what `BulletWorld.hand_over` gives; the rest as for `substep`. Fewer steps than asked for mean that
    the client, or a body in it, is gone.
    """
    handle = client_handle(engine.client, engine.body_count)
    if handle == 0:
        return 0
    for done in range(count):
        if not read_states(handle, engine.window, engine.body_ids, engine.two_link_rows, state.poses, state.angles):
            return done
        engine_substep(model, ground, state, out, dt, implicit)
        push_and_step(handle, engine.body_ids, engine.two_link_rows, state.poses, out.wrenches)
    return count
