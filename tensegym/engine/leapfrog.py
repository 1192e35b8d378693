"""The step of the leapfrog in engines whose velocity terms are explicit, compiled.

Forces of cables are taken well by both engines' own step, semi-implicit Euler, which for them is the leapfrog. What
they do wrong is the turning: gyroscopic and other velocity terms are taken at the old velocity, and a thin rod, whose
axial inertia is a thousandth of the other, gains energy and angular momentum by it. Both do it in the same way, so what
mends it stands here, once.
"""

from __future__ import annotations

from tensegym.compiled import kernel
from tensegym.physics.substep import substep
from tensegym.physics.vectors import ALLOCATING

from .joint_step import hold_joints
from .rod_rotation import turn_rods
from .split_rod_step import step_split_rods


@kernel(**ALLOCATING, forceinline=True)
def engine_substep(model, ground, state, out, dt, implicit):
    """`substep`, and then in place of the forces and moments on the bodies, out.wrenches, those under which the
    engine's step is one of the leapfrog. Of a second half a moment along the pin is left: its force has been carried
    over to the first one."""
    substep(model, ground, state, out, dt, implicit)
    if len(model.joint_bodies):
        hold_joints(model, state, dt, out)
    turn_rods(model.body_params, model.other_half, dt, out.rotations, out.velocities, out.wrenches)
    if len(model.pin_bodies):
        step_split_rods(model, state, dt, out)
