"""States of a hinge over its box of rotations and forces, by the FEM: for fits, and held out from them."""

from __future__ import annotations

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Box, Hinge, States
from tensegym.flexure.hinge.box import Ends
from tensegym.flexure.hinge.ranges import check_count, check_max_angle

from .equilibrium import rotate
from .mesh import ELEMENTS
from .path import CONVERGED

HELD_OUT_SEED = 12345
MOST_STATES = 100_000


def moment_at(hinge: Hinge, angle: float, elements: int = ELEMENTS) -> float:
    """Pure moment [N m] that turns the tip by ``angle`` [rad]. Raises FlexureError where there is none."""
    solution = rotate(hinge, np.array([angle]), elements=elements)
    if solution.status[0] != CONVERGED:
        raise FlexureError(f"{hinge.name}: {solution.reason(0)} (pure moment up to {angle:g} rad); lower max_angle")
    return float(solution.moment[0])


def default_box(
    hinge: Hinge, max_angle: float | None = None, max_force: float | None = None, force_x: Ends | None = None,
    force_y: Ends | None = None,
) -> Box:  # fmt: skip
    """The hinge's own range of rotation, and forces up to M / L with M the pure moment at the largest rotation.

    Args:
        hinge: whose box.
        max_angle: in place of the hinge's own [rad].
        max_force: in place of M / L [N].
        force_x, force_y: least and largest force on an axis, in place of +-max_force [N].
    """
    angle = hinge.max_angle if max_angle is None else max_angle
    check_max_angle(angle)
    largest = moment_at(hinge, angle) / hinge.length if max_force is None else max_force
    return Box(angle, largest, force_x, force_y)


def fit_states(hinge: Hinge, box: Box, count: int = 600, seed: int = 0, elements: int = ELEMENTS) -> States:
    """States for a fit: a scrambled Sobol sequence over the box, denser at its faces, where polynomials err most.

    Args:
        hinge, box: what, and where.
        count: of states, 8 or more.
        seed: of the scrambling.
        elements: of a leaf as long as the hinge.

    Raises:
        FlexureError: for too few states, and as ``states_at``.
    """
    from scipy.stats import qmc  # late: scipy.stats doubles the time of the import for all who only solve

    check_count("count", count, 8, MOST_STATES, "a fit needs 8 states or more")
    check_count("seed", seed, 0, 2**63, "give 0 or more")
    draws = qmc.Sobol(3, seed=seed).random_base2(int(np.ceil(np.log2(count))))[:count]
    return states_at(hinge, box, -np.cos(np.pi * draws), elements)


def held_out_states(
    hinge: Hinge, box: Box, count: int = 300, seed: int = HELD_OUT_SEED, elements: int = ELEMENTS
) -> States:
    """Uniformly random wrenches of the box, as ``fit_states`` counts them; keep the seed out of any fit."""
    check_count("held_out", count, 1, MOST_STATES, "300 tell the errors well")
    check_count("seed", seed, 0, 2**63, "give 0 or more")
    return states_at(hinge, box, np.random.default_rng([seed, 1]).uniform(-1, 1, (count, 3)), elements)


def states_at(hinge: Hinge, box: Box, unit: FloatArray, elements: int = ELEMENTS) -> States:
    """States at given places of the box, each by its path from rest.

    Args:
        hinge, box: what, and where.
        unit: (n, 3) in [-1, 1]: theta, force x, force y in units of the box.
        elements: of a leaf as long as the hinge.

    Raises:
        FlexureError: when one cannot be reached or is unstable under its dead load: the box goes past buckling.
    """
    force = box.centre + box.half * unit[:, 1:]
    solution = rotate(hinge, box.max_angle * unit[:, 0], force=force, elements=elements, from_rest=True)
    bad = np.flatnonzero((solution.status != CONVERGED) | ~solution.stable)
    if len(bad):
        i = int(bad[0])
        why = solution.reason(i) or "is unstable under that dead load: past buckling"
        raise FlexureError(
            f"{hinge.name}: at theta = {np.degrees(box.max_angle * unit[i, 0]):.3g} deg with the force "
            f"({force[i, 0]:.4g}, {force[i, 1]:.4g}) N the hinge {why}; lower "
            f"{f'max_force = {box.max_force:.4g} N' if box.symmetric else 'the forces'} or max_angle"
        )
    return solution.states()
