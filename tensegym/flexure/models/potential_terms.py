"""Which coefficients a potential has, by the symmetry of its hinge."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tensegym.errors import FlexureError

from .potential_kernel import NAMES, RHO, SA, SB, SIGMA, SK, SU, G, H

# powers of u of every row; a hinge symmetric about its axis and end to end needs the even ones only
EVEN = {SU: (0, 2, 4), SK: (0, 2, 4), SA: (0, 2), SB: (0, 2, 4), RHO: (2, 4, 6), SIGMA: (), H: (), G: (0, 2, 4)}
# symmetric about its axis only: theta and e_y change sign together
MIRROR = EVEN | {SIGMA: (1, 3, 5), H: (1, 3)}
# no symmetry
FREE = {SU: tuple(range(5)), SK: tuple(range(5)), SA: tuple(range(3)), SB: tuple(range(5)), RHO: tuple(range(1, 7)),
        SIGMA: tuple(range(1, 6)), H: tuple(range(4)), G: tuple(range(5))}  # fmt: skip
SYMMETRIES = {"both": EVEN, "axis": MIRROR, "none": FREE}
DEGREE = 6


def mask_of(symmetry: str) -> NDArray[np.bool_]:
    """(8, DEGREE + 1) which coefficients are fitted. Raises FlexureError."""
    if str(symmetry) not in SYMMETRIES:
        raise FlexureError(f"symmetry = {symmetry!r}; one of {', '.join(SYMMETRIES)}")
    mask = np.zeros((len(NAMES), DEGREE + 1), dtype=bool)
    for row, exponents in SYMMETRIES[symmetry].items():
        mask[row, list(exponents)] = True
    return mask
