"""Does a joint model make energy on closed loops? Work around random smooth loops, against the energy's swing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.flexure.hinge import Box, States

from .potential import Potential

SAMPLES = 256  # points a loop; sums of smooth periodic functions converge faster than any power
HARMONICS = 3


class WrenchModel(Protocol):
    """A model that can be asked both ways."""

    def poses(self, theta: FloatArray, force: FloatArray) -> States: ...

    def wrenches(self, poses: FloatArray) -> FloatArray: ...


@dataclass(frozen=True)
class LoopWork:
    """Over all loops: |work around| / (largest - smallest energy along)."""

    largest: float
    typical: float
    """Median."""


def random_loops(box: Box, count: int, seed: int) -> FloatArray:
    """(count, SAMPLES, 3) closed smooth loops of theta [rad], force x, y [N] that stay in the box."""
    rng = np.random.default_rng([seed, 2])
    phase = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
    order = np.arange(1, HARMONICS + 1)
    waves = np.concatenate([np.cos(np.outer(order, phase)), np.sin(np.outer(order, phase))])
    loops = rng.normal(size=(count, 3, 2 * HARMONICS)) @ waves + rng.normal(size=(count, 3, 1))
    loops *= rng.uniform(0.5, 1, (count, 3, 1)) / np.abs(loops).max(axis=2, keepdims=True)
    return np.asarray(loops.transpose(0, 2, 1) * [box.max_angle, *box.half] + [0.0, *box.centre])


def loop_work(model: WrenchModel, potential: Potential, count: int = 100, seed: int = 7) -> LoopWork:
    """Work of a model's wrench around closed loops of its own poses, under load loops inside the potential's box.

    Derivatives along a loop are spectral.

    Args:
        model: whose wrench.
        potential: gives the box, and the energy's swing under the same loads.
        count: of loops.
        seed: of their shapes.
    """
    shares = []
    frequency = np.fft.rfftfreq(SAMPLES, 1 / SAMPLES)
    frequency[-1] = 0.0  # the highest one has no derivative on the grid
    for loop in random_loops(potential.box, count, seed):
        states = model.poses(loop[:, 0], loop[:, 1:])
        poses = np.column_stack([states.tip, states.theta])
        speed = np.fft.irfft(1j * frequency[:, None] * np.fft.rfft(poses, axis=0), SAMPLES, axis=0)
        work = 2 * np.pi * np.mean(np.sum(model.wrenches(poses) * speed, axis=1))
        swing = np.ptp(potential.energies(potential.poses(loop[:, 0], loop[:, 1:])))
        shares.append(abs(work) / swing)
    return LoopWork(float(np.max(shares)), float(np.median(shares)))
