"""A design refused at a time step that does not hold it, with the parameter, its limit and the step that would."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.design.parameters import ElasticCable, Payload
from tensegym.errors import DesignError
from tensegym.physics.drives import drive_step_limit, most_gains
from tensegym.physics.model import Model
from tensegym.physics.robot_arrays import explicit_step_limit
from tensegym.physics.step_limit import Held, Margin, margin, most, pulled, shares, standing
from tensegym.physics.tangent import first_columns, tangent

from .energy_check import check_energy

Integrator = Literal["auto", "explicit", "implicit"]
# Of the margin's ratio at the deepest pull of all drives: its tensions are known to some 20 %, and robots pass it but
# seldom stay. Designs between 1 and this are let be, and named where they break
PULLED = 1.6
LEAST_TIME_STEP, LARGEST_TIME_STEP = 1e-6, 4e-3  # s; at 5 ms feet and rods in contact make energy, at 4 ms none did


class _Broken(NamedTuple):
    where: str
    state: Held
    implicit: bool
    margin: Margin


def held_implicit(design: RobotDesign, model: Model, dt: float, integrator: Integrator = "auto") -> bool:
    """Whether cable forces are implicit at a time step [s]: "auto" takes explicit ones where they hold the design.

    Raises DesignError where the step does not hold the robot at rest, or by far not at its drives' deepest pull
    (`tensegym.physics.step_limit`), where explicit forces are asked for over their limit, or where the drives hunt.
    """
    if not LEAST_TIME_STEP <= dt <= LARGEST_TIME_STEP:
        raise DesignError(f"dt = {dt!r} is outside [{LEAST_TIME_STEP:g}, {LARGEST_TIME_STEP:g}] s")
    limit = explicit_step_limit(model)
    if integrator == "explicit" and dt > limit:
        raise DesignError(f"dt = {dt:g} s is over the explicit limit of {limit:.3g} s; take integrator='implicit'")
    _check_drive(design, dt)
    rest = standing(model)
    check_energy(design, model, rest)
    # rods that share nodes would come apart in the relaxation; at rest the bound without joints is on the safe side
    states, broken = (rest, rest if len(model.joint_bodies) else pulled(design, model)), list[_Broken]()
    for implicit in _tried(dt, limit, integrator):
        found = _broken(model, states, dt, implicit)
        if found is None:
            return implicit
        broken.append(found)
    raise DesignError(_told(design, model, states, dt, broken[-1], integrator))


def _tried(dt: float, limit: float, integrator: Integrator) -> tuple[bool, ...]:
    if integrator == "auto":
        return (False, True) if dt <= limit else (True,)
    return (integrator == "implicit",)


def _broken(model: Model, states: tuple[Held, Held], dt: float, implicit: bool) -> _Broken | None:
    """The state that the step holds least, of those that it does not hold."""
    for where, state, most_ratio in zip(("at rest", "at the deepest pull"), states, (1.0, PULLED), strict=True):
        found = margin(model, state, dt, implicit)
        if not found.ratio < most_ratio:
            return _Broken(where, state, implicit, found)
    return None


def _largest_step(model: Model, states: tuple[Held, Held], dt: float, integrator: Integrator) -> float:
    """The largest time step that holds both states, to 1 %."""
    limit, low, high = explicit_step_limit(model), LEAST_TIME_STEP, dt
    while high > 1.01 * low:
        middle = float(np.sqrt(low * high))
        held = any(_broken(model, states, middle, way) is None for way in _tried(middle, limit, integrator))
        low, high = (middle, high) if held else (low, middle)
    return low


def _told(
    design: RobotDesign, model: Model, states: tuple[Held, Held], dt: float, broken: _Broken, integrator: Integrator
) -> str:
    where, state, implicit, found = broken
    parts = shares(model, state, dt, implicit, found.motion)
    source = max(parts, key=lambda name: parts[name])
    limit = most(model, state, dt, implicit, source, PULLED if where != "at rest" else 1.0)
    fix, pulls = f"dt below {_largest_step(model, states, dt, integrator):.3g} s", where != "at rest"
    cause, value, unit = _cause(design, model, state, source, pulls)
    fix = f"it must be below {limit * value:.3g} {unit}, or {fix}" if limit > 0 and unit else f"take {fix}"
    return (f"dt = {dt:g} s does not hold this design {where}: {cause} {_motion(design, model, state, found.motion)}; "
            f"{fix}")  # fmt: skip


def _cause(design: RobotDesign, model: Model, state: Held, source: str, pulls: bool) -> tuple[str, float, str]:
    """What outweighs the inertia, its value and unit."""
    rows = {"elastic": slice(0, model.first_driven), "stiff": model.driven, "payload": slice(model.driven.stop, None)}
    if source == "spin damping":
        return f"spin_damping = {design.spin_damping:g} N m s/rad", design.spin_damping, "N m s/rad"
    if source == "springs":
        return "the stiffness and damping of its cables", 0.0, ""
    tension = float(state.tensions[rows[source]].max())
    kind = {"elastic": "elastic cables", "stiff": "stiff cables", "payload": "payload's cables"}[source]
    group: Payload | ElasticCable | None = design.payload
    if source != "payload":
        group = max(design.each_cable, key=lambda cable: cable.pretension, default=None)
    if not pulls and group is not None and group.natural_length is None:
        return f"{type(group).__name__}.pretension = {group.pretension:g} N", group.pretension, "N"
    deepest = max((cable.max_pull for cable in design.each_stiff_cable), default=0.0)
    pull = f", drives at max_pull = {deepest:g}" if pulls else ""
    return f"a tension of {tension:.3g} N in the {kind}{pull},", tension, "N"


def _motion(design: RobotDesign, model: Model, state: Held, motion: FloatArray) -> str:
    """Which body it moves the most, by energy, and how."""
    at, first, count = tangent(model, *state), first_columns(model), len(design.structure.rods)
    energies = {}
    for body in np.setdiff1d(np.arange(len(model.masses)), model.pin_bodies[:, 1]):
        six = slice(first[body], first[body] + 6)
        own, mass = motion[six], at.mass[six, six]
        axis = _axis(state.poses[body, 3:])
        spin = float(model.inertias[body, 2] * (axis @ own[3:]) ** 2)
        energies[body, "shifts"] = float(own[:3] @ mass[:3, :3] @ own[:3])
        energies[body, "spins"] = spin
        energies[body, "swings"] = float(own[3:] @ mass[3:, 3:] @ own[3:]) - spin
    body, how = max(energies, key=lambda key: energies[key])
    if body == count:
        name, rod_inertia = "the payload", model.inertias[body, 0]
    else:
        name, rod_inertia = f"rod {'-'.join(map(str, design.structure.rods[body] + 1))}", model.inertias[body, 2]
    if how == "shifts":
        return f"shakes {name}, of {model.masses[body]:.3g} kg"
    if how == "swings" and body < count:
        return f"swings {name}, of {model.inertias[body, 0]:.3g} kg m^2 across its axis"
    return f"spins {name}, of {rod_inertia:.3g} kg m^2 about its axis"


def _axis(quaternion: FloatArray) -> FloatArray:
    x, y, z, w = quaternion
    return np.array([2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)])


def _check_drive(design: RobotDesign, dt: float) -> None:
    """Raise DesignError for a drive whose controller hunts."""
    drive = min(design.each_drive, key=drive_step_limit, default=None)
    if drive is None or dt < (limit := drive_step_limit(drive)):
        return
    position, velocity = most_gains(drive, dt)
    found = f"position_gain = {drive.position_gain:g} V/rad must be below {position:.3g}"
    if position <= 0.5 * drive.position_gain:
        found = f"velocity_gain = {drive.velocity_gain:g} V s/rad must be below {velocity:.3g}"
    if position <= 0.5 * drive.position_gain and velocity <= 0:
        found = "position_gain and velocity_gain must be lower"
    raise DesignError(f"dt = {dt:g} s makes the drives hunt about their commands: with Drive.rotor_inertia = "
                      f"{drive.rotor_inertia:g} kg m^2, {found}, or dt below {limit:.3g} s")  # fmt: skip
