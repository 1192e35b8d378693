"""Turning of thin rods, to second order and without drift.

Both engines step the gyroscopic term by explicit Euler, which gives a spinning rod energy and angular momentum in
proportion to dt. The kernel knows that update, so it commands the torque that makes the step come out as leapfrog does:
L(n + 1/2) = L(n - 1/2) + dt torque(n), with L = I(axis at the half step) w. That conserves angular momentum exactly and
the spin of a free rod too.
"""

from __future__ import annotations

from tensegym.compiled import kernel
from tensegym.physics.model import INVERSE_AXIAL, INVERSE_TRANSVERSE
from tensegym.physics.vectors import KERNEL, cross, dot, sine_ratios, turn


@kernel(**KERNEL)
def gyroscopic_change(w, axis, across, along, dt):
    """What an engine adds to the angular velocity w (3,) for the gyroscopic term, world axes.

    Explicit Euler, -dt I^-1 (w x I w), which for moments ``across`` and ``along`` ``axis`` is this closed form. (MuJoCo
    takes it in body axes; turning by w leaves w as it is, so that in world axes the step is the same.)
    """
    x, y, z = cross(w, axis)
    factor = dt * dot(w, axis) * (across - along) / across
    return factor * x, factor * y, factor * z


@kernel(**KERNEL)
def turn_rods(params, other_half, dt, rotations, velocities, wrenches):
    """Replace the moments in wrenches (b, 6) by those that make the engine take a leapfrog step under them; not of
    halves of split rods, see split_rod_step.py.

    params (b, 4), other_half (b,), rotations (b, 3, 3), velocities (b, 6): the Model's and the Out's.
    """
    for b in range(len(params)):
        across, along = 1 / params[b, INVERSE_TRANSVERSE], 1 / params[b, INVERSE_AXIAL]
        if other_half[b] >= 0 or across == along:
            continue  # split, or a ball, which has no gyroscopic term
        w = velocities[b, 3], velocities[b, 4], velocities[b, 5]
        axis = rotations[b, 0, 2], rotations[b, 1, 2], rotations[b, 2, 2]
        moment = wrenches[b, 3:]
        new = leapfrog_turn(w, axis, across, along, dt, moment)
        engine = gyroscopic_change(w, axis, across, along, dt)
        change = new[0] - w[0] - engine[0], new[1] - w[1] - engine[1], new[2] - w[2] - engine[2]
        part = (along - across) * dot(change, axis)
        for i in range(3):
            moment[i] = (across * change[i] + part * axis[i]) / dt


@kernel(**KERNEL)
def leapfrog_turn(w, axis, across, along, dt, moment):
    """The angular velocity (3,) after a step: I(half a step on) w_new = I(half a step ago) w + dt moment.

    With the axis half a step on as axis + s w x axis + c w x (w x axis), solved for w_new with s, c and the last term
    those of the last guess. What slows it is the spin's change with the tilt: at 2 ms three passes leave some 1e-9 of
    the moment at 3 rad/s, 1e-6 at 20 rad/s.
    """
    flat, inverse, half = along - across, 1 / across, 0.5 * dt
    middle = turn(axis, w, -half)
    old = flat * dot(w, axis)
    momentum = (across * w[0] + old * middle[0] + dt * moment[0], across * w[1] + old * middle[1] + dt * moment[1],
                across * w[2] + old * middle[2] + dt * moment[2])  # fmt: skip
    on_axis = dot(momentum, axis)
    for _ in range(3):
        square, spin = dot(w, w), dot(w, axis)
        s, c = sine_ratios(square * half * half)
        c *= half * half
        new_spin = on_axis / (along - flat * c * (square - spin * spin))
        pull = flat * new_spin
        k, less, more = pull * half * s * inverse, pull * (1 - c * square), pull * c * spin
        # w_new + k w_new x axis = r
        r = (inverse * (momentum[0] - less * axis[0] - more * w[0]),
             inverse * (momentum[1] - less * axis[1] - more * w[1]),
             inverse * (momentum[2] - less * axis[2] - more * w[2]))  # fmt: skip
        side, on, scale = cross(r, axis), dot(r, axis), 1 / (1 + k * k)
        w = (on * axis[0] + scale * (r[0] - on * axis[0] - k * side[0]),
             on * axis[1] + scale * (r[1] - on * axis[1] - k * side[1]),
             on * axis[2] + scale * (r[2] - on * axis[2] - k * side[2]))  # fmt: skip
    return w
