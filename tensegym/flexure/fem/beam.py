"""The corotational planar beam element, compiled.

Strain energy of one element of rest length l0, chord l, and end slopes a1, a2 against the chord [rad]:

    U = EA l0 / 2 eps^2 + 2 EI / l0 (a1^2 + a1 a2 + a2^2),   eps = (l - l0)/l0 + (2 a1^2 - a1 a2 + 2 a2^2)/30

The second part of eps is the shallow-arch membrane strain (the mean of v'^2 / 2 of the cubic shape, as in Crisfield,
Non-linear Finite Element Analysis of Solids and Structures, 1991, vol. 1, ch. 7.4); it makes positions converge as h^4.
"""

from __future__ import annotations

import math
from typing import Any

from tensegym.compiled import kernel

OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}


@kernel(**OPTIONS)
def wrapped(angle):
    """The angle in (-pi, pi] [rad]."""
    if -math.pi < angle <= math.pi:
        return angle
    return angle - 2 * math.pi * math.floor((angle + math.pi) / (2 * math.pi))


@kernel(**OPTIONS)
def strain(dx, dy, turn1, turn2, l0, cos0, sin0):
    """Chord length, its direction (c, s), end slopes and membrane strain of one element.

    (dx, dy) runs from node 1 to node 2 [m], turns are the nodes' rotations from rest [rad], (cos0, sin0) the chord's
    direction at rest.
    """
    chord = math.sqrt(dx * dx + dy * dy)
    swing = math.atan2(cos0 * dy - sin0 * dx, cos0 * dx + sin0 * dy)
    a1, a2 = wrapped(turn1 - swing), wrapped(turn2 - swing)
    eps = (chord - l0) / l0 + (2 * a1 * a1 - a1 * a2 + 2 * a2 * a2) / 30
    return chord, dx / chord, dy / chord, a1, a2, eps


@kernel(**OPTIONS)
def energy(dx, dy, turn1, turn2, l0, cos0, sin0, ea, ei):
    """Strain energy of one element [J]."""
    _, _, _, a1, a2, eps = strain(dx, dy, turn1, turn2, l0, cos0, sin0)
    return 0.5 * ea * l0 * eps * eps + 2 * ei / l0 * (a1 * a1 + a1 * a2 + a2 * a2)


@kernel(**OPTIONS)
def element(dx, dy, turn1, turn2, l0, cos0, sin0, ea, ei, axial, out):
    """Gradient and Hessian of the energy over (dx, dy, turn1, turn2), into ``out`` (20,).

    out[0:4] gradient; out[4:14] Hessian xx, xy, yy, x1, y1, x2, y2, 11, 12, 22; out[14:18] gradient of the strain eps;
    out[18] the axial force EA eps [N]; ``axial`` is the force used in the Hessian's geometric part. Carrying that as
    an unknown of its own (Magisano, Leonetti, Garcea, Int. J. Numer. Meth. Engng 109, 2017) leaves the solution as it
    is and takes away Newton's trouble with leaves that are far stiffer along than across.
    """
    chord, c, s, a1, a2, eps = strain(dx, dy, turn1, turn2, l0, cos0, sin0)
    force = ea * eps
    # with z = (-s, c): d chord = (c, s) . d(dx, dy), d swing = z . d(dx, dy) / chord
    e1, e2 = (4 * a1 - a2) / 30, (4 * a2 - a1) / 30
    k = 2 * ei / l0
    m1 = force * l0 * e1 + k * (2 * a1 + a2)
    m2 = force * l0 * e2 + k * (a1 + 2 * a2)
    shear = -(m1 + m2) / chord
    out[0], out[1], out[2], out[3] = force * c - shear * s, force * s + shear * c, m1, m2
    h1, h2 = axial * l0 * e1 + k * (2 * a1 + a2), axial * l0 * e2 + k * (a1 + 2 * a2)
    stretch, arch, twist = ea / l0, ea * l0, axial * l0 / 30
    k11 = arch * e1 * e1 + 4 * twist + 2 * k
    k12 = arch * e1 * e2 - twist + k
    k22 = arch * e2 * e2 + 4 * twist + 2 * k
    kl1, kl2 = ea * e1, ea * e2
    # chord frame: l along the chord, z across it
    row1, row2 = (k11 + k12) / chord, (k12 + k22) / chord
    zz = (row1 + row2) / chord + axial / chord
    lz = -(kl1 + kl2) / chord + (h1 + h2) / (chord * chord)
    out[4] = stretch * c * c - 2 * lz * c * s + zz * s * s
    out[5] = (stretch - zz) * c * s + lz * (c * c - s * s)
    out[6] = stretch * s * s + 2 * lz * c * s + zz * c * c
    out[7], out[8] = kl1 * c + row1 * s, kl1 * s - row1 * c
    out[9], out[10] = kl2 * c + row2 * s, kl2 * s - row2 * c
    out[11], out[12], out[13] = k11, k12, k22
    tilt = -(e1 + e2) / chord
    out[14], out[15] = c / l0 - tilt * s, s / l0 + tilt * c
    out[16], out[17] = e1, e2
    out[18] = force
