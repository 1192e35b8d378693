"""Winch drive: commanded spool angle in; rotor, gear and spool out; the cable's load torque fed back.

The winding's inductance is left out: its time constant (26 us with the paper's motor) is far below a time step.
Friction and gear losses are dry: they can hold the rotor but never drive it. The play in the gear only shifts the
spool while its cable is slack, since a cable can pull the spool but not push it: under load the same flank is in
contact, and rotor angle 0 is calibrated there.
"""

from __future__ import annotations

from dataclasses import astuple, fields

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.compiled import kernel
from tensegym.design.parameters import Drive

from .vectors import KERNEL

# Columns of a drive's state
COMMAND, ROTOR_ANGLE, ROTOR_SPEED, CURRENT, VOLTAGE, SPOOL_ANGLE, LOAD_TORQUE, PULLED = range(8)
STATE_SIZE = 8
DRIVE_FIELDS = len(fields(Drive))


def drive_constants(drive: Drive) -> FloatArray:
    """The fields of ``drive`` in their order, for the kernel: (DRIVE_FIELDS,), SI units."""
    return np.array(astuple(drive), dtype=float)


def winding_speed(drive: Drive) -> float:
    """Speed at which a drive winds an unloaded cable in [m/s]."""
    rotor = min(drive.speed_limit, drive.voltage_limit / drive.torque_constant)
    return rotor / drive.gear_ratio * drive.spool_radius


def drive_step_limit(drive: Drive) -> float:
    """Time step [s] from which on an unloaded drive without friction hunts about its command.

    Its loop is J w' + (Kt^2 / R) w + (Kt / R) (velocity_gain w + position_gain angle) = 0, with the back-emf at the end
    of a step and the controller at its start: stable below the positive root of
    dt^2 Kt position_gain / R + 2 dt Kt (velocity_gain - Kt) / R = 4 J, as `tensegym.physics.step_limit` derives.
    """
    per_volt = drive.torque_constant / drive.resistance
    square, linear = per_volt * drive.position_gain, per_volt * (drive.velocity_gain - drive.torque_constant)
    return float((np.sqrt(linear**2 + 4 * square * drive.rotor_inertia) - linear) / square)


def most_gains(drive: Drive, dt: float) -> tuple[float, float]:
    """The position gain [V/rad], and the velocity gain [V s/rad] at it, at which that limit is ``dt`` [s]; a position
    gain of 0 or below says that the velocity gain alone is too much."""
    per_volt = drive.torque_constant / drive.resistance
    room = 4 * drive.rotor_inertia + 2 * dt * per_volt * drive.torque_constant
    position = (room - 2 * dt * per_volt * drive.velocity_gain) / (per_volt * dt**2)
    return position, room / (2 * dt * per_volt) - dt * drive.position_gain / 2


@kernel(**KERNEL)
def _clip(value, limit):
    return min(max(value, -limit), limit)


@kernel(**KERNEL)
def drive_step(constants, state, tension, dt):
    """Advance one drive by ``dt`` [s] against its cable's ``tension`` [N]; updates ``state`` (8,) in place.

    Rotor: J w' = Kt i - load - friction, i = (V - Kt w) / R, both limits applied; V from a position controller on
    the rotor angle. Linearly implicit in w, so the electromechanical time constant (5 ms) does not limit dt.
    PULLED is the cable wound in during the step [m].
    """
    (radius, ratio, efficiency, backlash, resistance, kt, inertia, friction_current,
     voltage_limit, current_limit, speed_limit, position_gain, velocity_gain) = constants  # fmt: skip
    speed = state[ROTOR_SPEED]
    error = state[COMMAND] * ratio - state[ROTOR_ANGLE]
    voltage = _clip(position_gain * error - velocity_gain * speed, voltage_limit)

    load = tension * radius / ratio
    steady = 0.5 * (1 / efficiency + efficiency) * load
    dry = 0.5 * (1 / efficiency - efficiency) * load + kt * friction_current

    brake = 1 + dt * kt * kt / (resistance * inertia)  # back-emf
    moved = (speed + dt / inertia * (kt * voltage / resistance - steady)) / brake
    drag = dt / inertia * dry / brake
    moved = np.sign(moved) * max(0.0, abs(moved) - drag)
    current = (voltage - kt * moved) / resistance
    if abs(current) > current_limit:
        current = _clip(current, current_limit)
        moved = speed + dt / inertia * (kt * current - steady)
        moved = np.sign(moved) * max(0.0, abs(moved) - dt / inertia * dry)
    moved = _clip(moved, speed_limit)

    state[ROTOR_SPEED] = moved
    state[ROTOR_ANGLE] += dt * moved
    state[CURRENT] = current
    state[VOLTAGE] = voltage
    state[LOAD_TORQUE] = tension * radius
    shaft = state[ROTOR_ANGLE] / ratio
    if tension > 0:
        state[SPOOL_ANGLE] = shaft
    else:
        state[SPOOL_ANGLE] = min(max(state[SPOOL_ANGLE], shaft), shaft + backlash)
    state[PULLED] = dt * moved / ratio * radius
