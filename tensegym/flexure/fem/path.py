"""Paths of equilibrium states from load case to load case, no instability stepped over, compiled."""

from __future__ import annotations

import numpy as np

from tensegym.compiled import kernel

from .beam import OPTIONS
from .chain import EA, L0
from .memory import copy_state, memory, place_ends
from .newton import LOAD, ROTATION, WX, newton, settle

CONVERGED, BUCKLED, FAILED = 0, 1, 2
# Between accepted states, so that no instability is stepped over: the turn of any body [rad], and the gap between the
# energy gained and the work of the tip's loads by the trapezoid rule, of their size. A jump to another branch does not
# balance; along a branch the gap falls with the square of the step.
LARGEST_TURN, LARGEST_GAP = 0.25, 0.05
# A branch leaves a bifurcation across the tangent: the way gone must not be this many times the tangent's guess.
LARGEST_DETOUR, SMALLEST_DETOUR = 3.0, 1e-6
SMALLEST_STEP = 1e-4  # of a path, where it is given up


@kernel(**OPTIONS)
def near(mesh, mem, before):
    """Whether two settled states are neighbours on one branch."""
    tip = len(mesh.rest) - 1
    for b in range(1, tip + 1):
        if abs(mem.poses[b, 2] - before.poses[b, 2]) > LARGEST_TURN:
            return False
    work, size = 0.0, 0.0
    for i in range(3):
        share = 0.5 * (mem.held[i] + before.held[i]) * (mem.poses[tip, i] - before.poses[tip, i])
        work += share
        size += abs(share)
    gain = mem.held[3] - before.held[3]
    rounding = 1e-20 * mesh.pieces[0, EA] * mesh.pieces[0, L0] + 1e-12 * (mem.held[3] + before.held[3])
    return abs(gain - work) <= LARGEST_GAP * (abs(gain) + size) + rounding


@kernel(**OPTIONS)
def moved(mesh, mem, before):
    """Largest change of any node, as ``newton`` counts increments [rad, element lengths]."""
    largest = 0.0
    for m in range(len(mesh.ends)):
        _, _, count, first = mesh.ends[m]
        for i in range(first, first + count + 1):
            along = abs(mem.nodes[i, 0] - before.nodes[i, 0]) + abs(mem.nodes[i, 1] - before.nodes[i, 1])
            largest = max(largest, abs(mem.nodes[i, 2] - before.nodes[i, 2]), 0.5 * along / mesh.pieces[i, L0])
    return largest


@kernel(**OPTIONS)
def path(mesh, mem, spare, mode, start, target):
    """Follow the states between two load cases: (status, multiplier, fraction reached, free stable).

    BUCKLED: between the last stable state and a slightly larger load the tangent loses its positive definiteness (a
    bifurcation), or no state is near any more (a limit point, or a branch across the tangent); the fraction says where.
    """
    done, stride = 0.0, 1.0
    unstable = False
    case = np.empty(8)
    multiplier, free = 0.0, True
    while done < 1.0:
        stride = min(stride, 1.0 - done)
        end = done + stride if done + stride < 1.0 - 1e-12 else 1.0
        for i in range(8):
            case[i] = start[i] + end * (target[i] - start[i])
        copy_state(mem, spare)
        good, factor_, held, free_, first_step = newton(mesh, mem, mode, case)
        if good:
            settle(mesh, mem, mode, case, factor_)
            good = near(mesh, mem, spare) and moved(mesh, mem, spare) <= LARGEST_DETOUR * first_step + SMALLEST_DETOUR
        stable = held if mode == ROTATION else free_
        if good and stable:
            done, multiplier, free = end, factor_, free_
            stride *= 2
            continue
        unstable = unstable or good
        copy_state(spare, mem)
        stride /= 2
        if stride < SMALLEST_STEP:
            return (BUCKLED if unstable or mode == LOAD else FAILED), multiplier, done, free
    return CONVERGED, multiplier, 1.0, free


@kernel(**OPTIONS)
def sweep(mesh, mode, cases, from_rest, keep_nodes):
    """Solve for every row of ``cases`` (n, 8) in turn.

    ``from_rest``: each state by its own path from rest, else from the state before. Returns results (n, 8): turn, tip x
    and y, force x and y and moment about the tip that hold it, energy, fraction of the path reached; status (n,), free
    stability (n,), and nodes (n, k, 3) when kept.
    """
    count = len(cases)
    tip = len(mesh.rest) - 1
    mem, spare, rest = memory(mesh), memory(mesh), memory(mesh)
    history = [memory(mesh), memory(mesh), memory(mesh)]
    known = 0
    results = np.full((count, 8), np.nan)
    status, stable = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.bool_)
    nodes = np.zeros((count if keep_nodes else 0, len(mem.nodes), 3))
    start = np.zeros(8)
    for i in range(count):
        case = cases[i]
        if from_rest or (i > 0 and status[i - 1] != CONVERGED) or i == 0:
            copy_state(rest, mem)
            for j in range(8):
                start[j] = case[j] if j >= WX else 0.0
            known = 0
        state, done = FAILED, 0.0
        multiplier, free = 0.0, False
        if known == 3 and mode == ROTATION:  # quadratic extrapolation: saves an iteration or two on an even sweep
            extrapolate(mesh, history[i % 3], history[(i + 1) % 3], history[(i + 2) % 3], mem)
            good, multiplier, held, free, _ = newton(mesh, mem, mode, case)
            before = history[(i + 2) % 3]
            if good and held:
                settle(mesh, mem, mode, case, multiplier)
                if near(mesh, mem, before):
                    state, done = CONVERGED, 1.0
            if state != CONVERGED:
                copy_state(before, mem)
        if state != CONVERGED:
            state, multiplier, done, free = path(mesh, mem, spare, mode, start, case)
        status[i], stable[i] = state, free
        results[i, 7] = done
        if keep_nodes:
            for k in range(len(mem.nodes)):
                for j in range(3):
                    nodes[i, k, j] = mem.nodes[k, j]
        if state != CONVERGED:
            continue
        if not from_rest:
            copy_state(mem, history[i % 3])
            known = min(known + 1, 3)
            for j in range(8):
                start[j] = case[j]
        results[i, 0], results[i, 1], results[i, 2] = mem.poses[tip, 2], mem.poses[tip, 0], mem.poses[tip, 1]
        for j in range(4):
            results[i, 3 + j] = mem.held[j]
    return results, status, stable, nodes


@kernel(**OPTIONS)
def extrapolate(mesh, oldest, older, last, mem):
    """Quadratic extrapolation over three even steps, into ``mem``."""
    for i in range(len(mem.poses)):
        for j in range(3):
            mem.poses[i, j] = 3 * (last.poses[i, j] - older.poses[i, j]) + oldest.poses[i, j]
    for i in range(len(mem.nodes)):
        mem.axial[i] = 3 * (last.axial[i] - older.axial[i]) + oldest.axial[i]
        for j in range(3):
            mem.nodes[i, j] = 3 * (last.nodes[i, j] - older.nodes[i, j]) + oldest.nodes[i, j]
    for m in range(len(mesh.ends)):
        place_ends(mesh, mem, m)
