"""The force law: lengths of springs and their rates to tensions, and those to wrenches on the bodies, compiled.

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

from tensegym.compiled import kernel

from .mobility import mobility_matrix, whole_blocks
from .model import DAMPING, STIFFNESS, TWO_WAY
from .vectors import INLINED, KERNEL

_MAX_SWEEPS, _TOLERANCE = 200, 1e-6  # of the implicit solve; changes below 1e-6 of the largest tension end it
_SLOW = 0.1  # (dt w)^2 and dt c A below which a flexure's row stays explicit; the scheme is stable up to 4


@kernel(**KERNEL)
def explicit_tensions(springs, lengths, rates, natural, tensions):
    """Write the tensions (s,) of the state as it is; springs (s, 9) as in Model."""
    for c in range(len(tensions)):
        stretch = lengths[c] - natural[c]
        tension = springs[c, STIFFNESS] * stretch + springs[c, DAMPING] * rates[c]
        if springs[c, TWO_WAY] == 0 and (stretch <= 0 or tension < 0):
            tension = 0.0
        tensions[c] = tension


@kernel(**KERNEL)
def is_slow(mobility, stiffness, damping, dt):
    """Whether a flexure's own motion, at a mobility of its angle [1/(kg m^2)], is slow against the step: see above."""
    return dt * mobility * max(dt * stiffness, damping) < _SLOW


@kernel(**INLINED)
def implicit_tensions(model, out, lengths, rates, natural, dt, tensions):
    """Write the tensions (s,) at the end of the step, from the geometry in ``out``; they start from the last step's.

    Slack rows stay out of it. Of the others, in their order, out.solve holds the weights, the residuals (target - A T,
    kept up to date: a whole row a change, which vectorises), the pivots and the tensions.
    """
    springs, rows, mobility = model.spring_params, out.rows, out.mobility
    weight, residual, pivot, tension = out.solve[0], out.solve[1], out.solve[2], out.solve[3]
    cables, count = len(lengths) - len(model.pin_bodies), 0
    for c in range(len(lengths)):
        k, damping = springs[c, STIFFNESS], springs[c, DAMPING]
        stretch = lengths[c] + dt * rates[c] - natural[c]
        if springs[c, TWO_WAY] == 0 and stretch <= 0:
            tensions[c] = 0.0
            continue
        rows[count], tension[count] = c, tensions[c]
        weight[count] = 1 / (dt * damping + dt * dt * k)
        residual[count] = weight[count] * (k * stretch + damping * rates[c])
        count += 1
    mobility_matrix(model, out, count)
    width = whole_blocks(count)
    for r in range(count, width):
        residual[r] = 0.0
    for r in range(count):
        c = rows[r]
        k, damping = springs[c, STIFFNESS], springs[c, DAMPING]
        if c >= cables and is_slow(mobility[r, r], k, damping, dt):
            weight[r] = np.inf
            tension[r] = k * (lengths[c] - natural[c]) + damping * rates[c]
        pivot[r] = mobility[r, r] + weight[r]
    for r in range(count):
        if tension[r] != 0:
            for d in range(width):
                residual[d] -= mobility[r, d] * tension[r]
    for _ in range(_MAX_SWEEPS):
        change, scale = 0.0, 1e-9
        for r in range(count):
            if weight[r] == np.inf:
                continue
            new = tension[r] + (residual[r] - weight[r] * tension[r]) / pivot[r]
            if new < 0 and springs[rows[r], TWO_WAY] == 0:
                new = 0.0
            step = new - tension[r]
            if step != 0:
                for d in range(width):
                    residual[d] -= mobility[r, d] * step
                tension[r] = new
            change = max(change, abs(step))
            scale = max(scale, abs(new))
        if change <= _TOLERANCE * scale:
            break
    for r in range(count):
        tensions[rows[r]] = tension[r]


@kernel(**KERNEL)
def tension_wrenches(ends, out, tensions):
    """Write in out.wrenches what tensions (s,) do to the bodies; ends (s, 2) as Model.spring_bodies."""
    wrenches, directions, arms = out.wrenches, out.directions, out.moment_arms
    wrenches[:] = 0.0
    for c in range(len(ends)):
        for side in range(2):
            pull = tensions[c] if side == 0 else -tensions[c]
            body = ends[c, side]
            for i in range(3):
                wrenches[body, i] += pull * directions[c, i]
                wrenches[body, 3 + i] -= tensions[c] * arms[c, side, i]
