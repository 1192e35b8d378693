"""Whether a time step holds a robot in a state: the exact bound of the substep's scheme, linearised.

With v(n) = (x(n) - x(n-1)) / dt the substep takes tensions at the end of a step along the cables, K_i and C_i, where
they are implicit, and everything at its start else: K_e, which has the geometric stiffness of tensioned cables, the
pull of cables tied beside an axis and explicit springs in it, and C_e, the damping of spins and explicit dampers:

    (M + dt C_i + dt^2 K_i) v(n+1) = M v(n) - dt C_e v(n) - dt (K_e + K_i) x(n).

All are symmetric. For an eigenvector z of x(n) = z^n x the polynomial's coefficients are their values on it, so roots
leave the unit circle at z = -1 alone (Jury's conditions) unless a stiffness or a damping is negative: the step holds
the state if, and only if,

    S = dt^2 (K_e - K_i) + 2 dt (C_e - C_i) < 4 M.

This is the step limit of central differences (Belytschko, Liu, Moran 2000, Nonlinear Finite Elements, 6.2) for a scheme
that is implicit in part.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign

from .cable_law import explicit_tensions, is_slow
from .geometry import spring_geometry
from .model import DAMPING, STIFFNESS, Model, new_out
from .pulled import pulled_state
from .tangent import Tangent, tangent

SOURCES = ("elastic", "stiff", "payload", "spin damping", "springs")  # of what outweighs the inertia


class Held(NamedTuple):
    """A state that a time step is to hold."""

    poses: FloatArray
    """(b, 7)."""
    angles: FloatArray
    """(p,) [rad]."""
    tensions: FloatArray
    """(s,) [N], [N m]; 0 of slack cables, which take no part."""


class Margin(NamedTuple):
    """How near a state is to what the time step holds."""

    ratio: float
    """Largest eigenvalue of S over 4 M; unstable above 1."""
    motion: FloatArray
    """(n,) its motion, over the coordinates of `tangent`."""


def standing(model: Model) -> Held:
    """The robot at rest, stiff cables slack."""
    angles, lengths, tensions = np.zeros(len(model.pin_bodies)), *np.empty((2, len(model.spring_bodies)))
    spring_geometry(model, model.rest_poses, angles, new_out(model), lengths)
    explicit_tensions(model.spring_params, lengths, np.zeros_like(lengths), model.rest_lengths, tensions)
    tensions[model.driven] = 0.0
    return Held(model.rest_poses, angles, tensions)


def pulled(design: RobotDesign, model: Model, part: float = 1.0) -> Held:
    """The robot with all its drives at a part of their deepest pull."""
    return Held(*pulled_state(design, model, part))


def margin(model: Model, state: Held, dt: float, implicit: bool) -> Margin:
    """Of a state at a time step [s] under implicit or explicit cable forces."""
    at = tangent(model, *state)
    against = at.geometric * dt**2 + 2 * dt * at.spin_damping + _along(model, at, state, dt, implicit)
    last = len(against) - 1
    values, vectors = eigh(against, 4 * at.mass, subset_by_index=[last, last])
    return Margin(float(values[0]), vectors[:, 0])


def shares(model: Model, state: Held, dt: float, implicit: bool, motion: FloatArray) -> dict[str, float]:
    """What each of SOURCES puts against the inertia in a motion, as parts of S."""
    matrices = _matrices(model, state, dt, implicit)
    return {name: float(motion @ matrix @ motion) for name, matrix in matrices.items()}


def most(model: Model, state: Held, dt: float, implicit: bool, source: str, ratio: float = 1.0) -> float:
    """The multiple of a source, tensions of a group of cables or the damping of spins, up to which the margin's ratio
    is below ``ratio``; 0 where it is not with none of it."""
    matrices, mass = _matrices(model, state, dt, implicit), tangent(model, *state).mass
    own = matrices.pop(source)
    rest = 4 * ratio * mass - np.sum(list(matrices.values()), axis=0)
    if eigh(rest, mass, eigvals_only=True, subset_by_index=[0, 0])[0] <= 0:
        return 0.0
    last = len(own) - 1
    return 1 / float(eigh(own, rest, eigvals_only=True, subset_by_index=[last, last])[0])


def _matrices(model: Model, state: Held, dt: float, implicit: bool) -> dict[str, FloatArray]:
    """S (n, n) by SOURCES."""
    groups = {"elastic": slice(0, model.first_driven), "stiff": model.driven,
              "payload": slice(model.driven.stop, None)}  # fmt: skip
    found = {}
    for name, rows in groups.items():
        own = np.zeros_like(state.tensions)
        own[rows] = state.tensions[rows]
        found[name] = dt**2 * tangent(model, state.poses, state.angles, own).geometric
    at = tangent(model, *state)
    found["spin damping"] = 2 * dt * at.spin_damping
    found["springs"] = _along(model, at, state, dt, implicit)
    return found


def _along(model: Model, at: Tangent, state: Held, dt: float, implicit: bool) -> FloatArray:
    """What springs and dampers along the cables, and flexures, put against the inertia: less than none if implicit."""
    sign = np.full(len(state.tensions), -1.0 if implicit else 1.0)
    sign[(state.tensions == 0) & (np.arange(len(sign)) < model.first_flexure)] = 0.0
    stiff, damp = model.spring_params[:, STIFFNESS], model.spring_params[:, DAMPING]
    if implicit:
        bends = at.rates[model.first_flexure :]
        own = np.einsum("cn,nc->c", bends, np.linalg.solve(at.mass, bends.T))
        for row, mobility in enumerate(own, start=model.first_flexure):
            sign[row] = 1.0 if is_slow(mobility, stiff[row], damp[row], dt) else -1.0
    weight = sign * (dt**2 * stiff + 2 * dt * damp)
    return at.rates.T @ (weight[:, None] * at.rates)
