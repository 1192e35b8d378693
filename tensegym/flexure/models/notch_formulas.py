"""Closed forms of notches that hardly turn: compliance of an elliptic notch, and the approximation for thin webs.

Paros and Weisbord, How to design flexure hinges, Machine Design 37, 1965: the circular notch, both forms. Smith,
Badami, Dale and Xu, Elliptical flexure hinges, Rev. Sci. Instrum. 68, 1997: an elliptic one is as compliant as the
circular one of its semi-axis across, times the ratio of its semi-axes. Both are integrals of 12 / (E b t(x)^3).
"""

from __future__ import annotations

import math


def notch_compliance(modulus: float, width: float, web: float, along: float, across: float) -> float:
    """Turn over pure moment [rad/(N m)] of an elliptic notch that runs to its full depth.

    Args:
        modulus: E [Pa].
        width: out of plane [m].
        web: thinnest thickness [m].
        along, across: semi-axes [m]; equal for a circle.
    """
    beta = web / (2 * across)
    square = beta * (2 + beta)
    first = (1 + (3 + 2 * beta + beta**2) / square) / (1 + beta)
    second = 6 * (1 + beta) / square**1.5 * math.atan(math.sqrt((2 + beta) / beta))
    return 3 / (2 * modulus * width * across**2 * square) * (first + second) * along / across


def thin_notch_compliance(modulus: float, width: float, web: float, radius: float) -> float:
    """The circular notch's where the web is thin: 9 pi sqrt(r) / (2 E b t^(5/2))."""
    return 9 * math.pi * math.sqrt(radius) / (2 * modulus * width * web**2.5)
