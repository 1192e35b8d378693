"""The force law: cable lengths and their rates to tensions, and those to wrenches on the bodies, compiled.

Cables are spring-dampers, T = max(0, k (l - l0) + c dl/dt) and exactly 0 when l <= l0; two-way cables (the paper's
springs) leave out the max. Length rates are differenced in time, so only poses are read from the engine. Explicit
tensions use the state at the start of a step; implicit ones solve for the tensions at its end,

    (A + 1 / (dt c + dt^2 k)) T = (k (l + dt dl/dt - l0) + c dl/dt) / (dt c + dt^2 k),   A = J M^-1 J^T,

a linear complementarity problem with T >= 0, where J maps body velocities to length rates. It is symmetric positive
definite, so projected Gauss-Seidel converges to its only solution.

The flexure of a split rod is one more row: a two-way spring whose length is the angle of its pin [rad], tension its
moment [N m]. Where its own motion is slow against the step it keeps its explicit force in an implicit step too.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .cable_geometry import cable_geometry, flexure_geometry
from .mobility import mobility_matrix

# Columns of a cable's parameter row
LOCAL_A, LOCAL_B, STIFFNESS, DAMPING, TWO_WAY = slice(0, 3), slice(3, 6), 6, 7, 8
_MAX_SWEEPS, _TOLERANCE = 200, 1e-6  # of the implicit solve; changes below 1e-6 of the largest tension end it
_SLOW = 0.1  # (dt w)^2 and dt c A below which a flexure's row stays explicit; the scheme is stable up to 4


@njit(cache=True)
def explicit_tensions(cables, lengths, rates, natural, tensions):
    """Tensions (c,) [N] of the state as it is."""
    for c in range(len(tensions)):
        stretch = lengths[c] - natural[c]
        tension = cables[c, STIFFNESS] * stretch + cables[c, DAMPING] * rates[c]
        if cables[c, TWO_WAY] == 0 and (stretch <= 0 or tension < 0):
            tension = 0.0
        tensions[c] = tension


@njit(cache=True)
def implicit_tensions(poses, ends, cables, bodies, partner, pins, pin_params, turns, directions, lengths, rates,
                      natural, dt, tensions):  # fmt: skip
    """Tensions (c,) [N] at the end of the step; ``tensions`` holds the last step's as the starting guess."""
    count = len(ends)
    mobility = np.empty((count, count))
    mobility_matrix(poses, ends, bodies, partner, pins, pin_params, turns, directions, mobility)
    weight, target = np.empty(count), np.empty(count)
    for c in range(count):
        k, damping = cables[c, STIFFNESS], cables[c, DAMPING]
        weight[c] = 1 / (dt * damping + dt * dt * k)
        stretch = lengths[c] + dt * rates[c] - natural[c]
        target[c] = weight[c] * (k * stretch + damping * rates[c])
        if cables[c, TWO_WAY] == 0 and stretch <= 0:
            target[c] = 0.0  # stays slack
            weight[c] = np.inf
            tensions[c] = 0.0
    for c in range(count - len(pins), count):
        k, damping = cables[c, STIFFNESS], cables[c, DAMPING]
        if dt * mobility[c, c] * max(dt * k, damping) < _SLOW:
            weight[c] = np.inf
            tensions[c] = k * (lengths[c] - natural[c]) + damping * rates[c]
    residual = target.copy()  # target - A T, kept up to date: a whole row a change, which vectorises
    for c in range(count):
        if tensions[c] != 0:
            for d in range(count):
                residual[d] -= mobility[c, d] * tensions[c]
    for _ in range(_MAX_SWEEPS):
        change, scale = 0.0, 1e-9
        for c in range(count):
            if weight[c] == np.inf:
                continue
            new = tensions[c] + (residual[c] - weight[c] * tensions[c]) / (mobility[c, c] + weight[c])
            if cables[c, TWO_WAY] == 0 and new < 0:
                new = 0.0
            step = new - tensions[c]
            if step != 0:
                for d in range(count):
                    residual[d] -= mobility[c, d] * step
                tensions[c] = new
            change = max(change, abs(step))
            scale = max(scale, abs(new))
        if change <= _TOLERANCE * scale:
            break


@njit(cache=True)
def wrenches_of(ends, turns, directions, tensions, wrenches):
    """Force and moment (b, 6) on every body about its centre, world axes, by tensions (c,)."""
    wrenches[:] = 0.0
    for c in range(len(ends)):
        for side in range(2):
            pull = tensions[c] if side == 0 else -tensions[c]
            body = ends[c, side]
            for i in range(3):
                wrenches[body, i] += pull * directions[c, i]
                wrenches[body, 3 + i] -= tensions[c] * turns[c, side, i]


@njit(cache=True)
def start(poses, angles, ends, cables, pins, pin_params, springs):
    """Set lengths, rates, tensions of ``springs`` (4, c) for a state at rest; its last row is the natural lengths."""
    count, flexures = len(ends), len(ends) - len(pins)
    turns, directions = np.empty((count, 2, 3)), np.empty((count, 3))
    cable_geometry(poses, ends[:flexures], cables, turns, directions, springs[0])
    flexure_geometry(poses, pins, pin_params, angles, flexures, turns, directions, springs[0])
    springs[1] = 0.0
    explicit_tensions(cables, springs[0], springs[1], springs[3], springs[2])
