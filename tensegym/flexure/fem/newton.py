"""Newton's method for one load case, under rotation or load control, compiled."""

from __future__ import annotations

import math

from tensegym.compiled import kernel

from .assembly import assemble, strain_energy
from .beam import OPTIONS
from .chain import AX, AY, BX, BY, recover
from .ldl import backward, factor, forward
from .memory import place_ends

ROTATION, LOAD = 0, 1
# a load case: turn [rad]; dead force [N] and moment [N m] at the tip; direction scaled under rotation control (force x,
# y and moment about the tip); distance of the dead force's point beyond the tip along the tip body's x [m]
THETA, FX, FY, MZ, WX, WY, WM, ARM = range(8)
TOLERANCE = 1e-7  # largest increment [rad, element lengths]; Newton converges quadratically, so the error is its square
ITERATIONS = 15


@kernel(**OPTIONS)
def newton(mesh, mem, mode, case):
    """Solve for one load case from where ``mem`` is: (converged, multiplier, held stable, free stable, first step).

    The first step is the largest increment of the first iteration, the tangent's guess [rad, element lengths]. Held
    stable: a minimum of the energy at the turn asked for; free stable: a minimum under the dead load.
    """
    tip = len(mesh.rest) - 1
    size = 3 * tip
    matrix, right, step = mem.matrix, mem.right[0], mem.right[1]
    scale = 1 / mesh.rest[tip, 0] if mesh.rest[tip, 0] != 0.0 else 1.0
    multiplier, first_step = 0.0, 0.0
    for iteration in range(ITERATIONS):
        inner = assemble(mesh, mem)
        turn = mem.poses[tip, 2]
        lever_x, lever_y = case[ARM] * math.cos(turn), case[ARM] * math.sin(turn)
        for i in range(size):
            right[i] = -right[i]
        right[size - 3] += case[FX]
        right[size - 2] += case[FY]
        right[size - 1] += case[MZ] + lever_x * case[FY] - lever_y * case[FX]
        matrix[size - 1, size - 1] += lever_x * case[FX] + lever_y * case[FY]
        negative, last = factor(matrix)
        forward(matrix, right)
        if mode == ROTATION:
            for i in range(size):
                step[i] = 0.0
            step[size - 3], step[size - 2], step[size - 1] = case[WX], case[WY], case[WM]
            forward(matrix, step)
            delta = case[THETA] - turn
            multiplier = (matrix[size - 1, size - 1] * delta - right[size - 1]) / step[size - 1]
            for i in range(size - 1):
                right[i] = (right[i] + multiplier * step[i]) / matrix[i, i]
            right[size - 1] = delta
        else:
            for i in range(size):
                right[i] /= matrix[i, i]
        backward(matrix, right)
        largest = 0.0
        for b in range(tip):
            largest = max(largest, abs(right[3 * b]) * scale, abs(right[3 * b + 1]) * scale, abs(right[3 * b + 2]))
        if not largest < 10.0:
            return False, multiplier, False, False, first_step
        for m in range(len(mesh.ends)):
            a, b, count, first = mesh.ends[m]
            real = mesh.real[m]
            for end, body, x, y in ((0, a, real[AX], real[AY]), (1, b, real[BX], real[BY])):
                if body > 0:
                    c, s = math.cos(mem.poses[body, 2]), math.sin(mem.poses[body, 2])
                    k = 3 * (body - 1)
                    mem.step[end, 0] = right[k] - (s * x + c * y) * right[k + 2]
                    mem.step[end, 1] = right[k + 1] + (c * x - s * y) * right[k + 2]
                    mem.step[end, 2] = right[k + 2]
                else:
                    mem.step[end, 0], mem.step[end, 1], mem.step[end, 2] = 0.0, 0.0, 0.0
            inside = recover(mem.nodes[first:], mem.axial[first:], mesh.pieces[first:], count, a == 0,
                             mem.strains[first:], mem.back[first:], mem.step[0], mem.step[1])  # fmt: skip
            largest = max(largest, inside)
        for b in range(1, tip + 1):
            for i in range(3):
                mem.poses[b, i] += right[3 * (b - 1) + i]
        for m in range(len(mesh.ends)):
            place_ends(mesh, mem, m)
        if iteration == 0:
            first_step = largest
        if largest < TOLERANCE and iteration > 0:  # stability is judged on the tangent at this state, not the last one
            held = negative + inner == 0
            return True, multiplier, held, held and not last, first_step
    return False, multiplier, False, False, first_step


@kernel(**OPTIONS)
def settle(mesh, mem, mode, case, multiplier):
    """Note what holds a converged state, and its energy."""
    turn = mem.poses[len(mesh.rest) - 1, 2]
    scale = multiplier if mode == ROTATION else 0.0
    lever = case[ARM] * (math.cos(turn) * case[FY] - math.sin(turn) * case[FX])
    mem.held[0] = case[FX] + scale * case[WX]
    mem.held[1] = case[FY] + scale * case[WY]
    mem.held[2] = case[MZ] + scale * case[WM] + lever
    mem.held[3] = strain_energy(mesh, mem)
