"""States: what a hinge was seen to do, whoever saw it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError

from .ranges import number_array

_SHAPES = {"theta": (), "tip": (2,), "force": (2,), "moment": ()}


@dataclass(frozen=True)
class States:
    """n equilibrium states of one hinge, from a FEM or a measurement.

    Raises FlexureError on shapes that do not agree or infinite values. NaN marks what was not measured (never theta).
    """

    theta: FloatArray
    """(n,) turn of the tip body [rad]."""
    tip: FloatArray
    """(n, 2) position of the tip in base axes [m]."""
    force: FloatArray
    """(n, 2) force on the tip body at the tip, in base axes [N]."""
    moment: FloatArray
    """(n,) moment on the tip body about the tip [N m]."""

    def __post_init__(self) -> None:
        for name in _SHAPES:
            object.__setattr__(self, name, np.ascontiguousarray(number_array(getattr(self, name), name)))
        if self.theta.ndim != 1:
            raise FlexureError(f"theta has shape {self.theta.shape}; give one angle a state, shape (n,)")
        for name, tail in _SHAPES.items():
            value = getattr(self, name)
            if value.shape != (len(self.theta), *tail):
                raise FlexureError(f"{name} has shape {value.shape}; {len(self.theta)} states need "
                                   f"{(len(self.theta), *tail)}")  # fmt: skip
            bad = np.isinf(value) if name != "theta" else ~np.isfinite(value)
            if bad.any():
                raise FlexureError(f"{name} of state {int(np.argwhere(bad)[0, 0])} is not finite; remove that state")

    def __len__(self) -> int:
        return len(self.theta)

    def pick(self, index: NDArray[np.intp] | NDArray[np.bool_] | slice) -> States:
        """The states of ``index``, as numpy indexes."""
        return States(self.theta[index], self.tip[index], self.force[index], self.moment[index])

    def whole(self) -> States:
        """Only the states with every component known."""
        known = np.isfinite(self.tip).all(1) & np.isfinite(self.force).all(1) & np.isfinite(self.moment)
        return self.pick(known)


def join(parts: list[States]) -> States:
    """One States of all parts, in order."""
    return States(*(np.concatenate([getattr(p, name) for p in parts]) for name in _SHAPES))
