"""Springs of flexure joints, compiled: energy, gradient and Hessian over the joint's own coordinates.

Coordinates of a joint: tip x, y [m] in base axes and theta [rad]; then, where it gives out of its plane, z [m] and the
turns about the tip's y and x. The gradient over x, y, theta is the wrench that holds the spring, about the tip.
"""

from __future__ import annotations

import math

import numpy as np

from tensegym.compiled import kernel
from tensegym.flexure.fem.beam import OPTIONS
from tensegym.flexure.models import potential_kernel

POTENTIAL, PLANAR, TORSION = range(3)


@kernel(**OPTIONS)
def planar(row, x, y, theta, gradient, hessian):
    """PlanarSpring over the tip's pose; row: L, b L, kx, ky, kz. The gradient and Hessian of its V, see planar_spring.

    With u = c x + s y, w = c y - s x of the spring's own origin x, y = tip - (L - b L + b L c, b L s).
    """
    arm, kx, ky, kz = row[1], row[2], row[3], row[4]
    c, s = math.cos(theta), math.sin(theta)
    x, y = x - row[0] + arm - arm * c, y - arm * s
    u, w = c * x + s * y, c * y - s * x
    half = 0.5 * (kx - ky)
    gx = 0.5 * (kx * x + kx * u * c - ky * w * s)
    gy = 0.5 * (ky * y + kx * u * s + ky * w * c)
    xx = 0.5 * (kx + kx * c * c + ky * s * s)
    yy = 0.5 * (ky + kx * s * s + ky * c * c)
    xy = half * c * s
    xt, yt = half * (w * c - u * s), half * (w * s + u * c)
    dx, dy = arm * s, -arm * c  # of the spring's origin over theta at a fixed tip
    gradient[0], gradient[1] = gx, gy
    gradient[2] = half * u * w + kz * s + gx * dx + gy * dy
    hessian[0, 0], hessian[0, 1], hessian[1, 1] = xx, xy, yy
    hessian[0, 2] = xt + xx * dx + xy * dy
    hessian[1, 2] = yt + xy * dx + yy * dy
    hessian[2, 2] = (half * (w * w - u * u) + kz * c + 2 * (xt * dx + yt * dy) + xx * dx * dx + 2 * xy * dx * dy
                     + yy * dy * dy + gx * arm * c + gy * arm * s)  # fmt: skip
    hessian[1, 0], hessian[2, 0], hessian[2, 1] = xy, hessian[0, 2], hessian[1, 2]
    return 0.25 * (kx * x * x + ky * y * y + kx * u * u + ky * w * w) + kz * (1 - c)


@kernel(**OPTIONS)
def spring(springs, f, pose, gradient, hessian):
    """Energy [J] of joint f at its pose (6,); writes the gradient (6,) and the Hessian (6, 6)."""
    gradient[:], hessian[:] = 0.0, 0.0
    kind = springs.kind[f]
    if kind == POTENTIAL:
        plane = np.empty((3, 3))
        gradient[0], gradient[1], gradient[2], energy = potential_kernel.stiffness(
            springs.coefficients[f], springs.rows[f], pose[0], pose[1], pose[2], plane
        )
        hessian[:3, :3] = plane
    elif kind == PLANAR:
        energy = planar(springs.rows[f], pose[0], pose[1], pose[2], gradient, hessian)
    else:
        stiffness = springs.rows[f, 2]
        gradient[2], hessian[2, 2] = stiffness * pose[2], stiffness
        energy = 0.5 * stiffness * pose[2] ** 2
    for k in range(3):
        stiffness = springs.across[f, k]
        gradient[3 + k] += stiffness * pose[3 + k]
        hessian[3 + k, 3 + k] += stiffness
        energy += 0.5 * stiffness * pose[3 + k] ** 2
    return energy


@kernel(**OPTIONS)
def pose_of(springs, f, q, out):
    """Pose (6,) of joint f at joint positions q (j,)."""
    for k in range(6):
        column = springs.columns[f, k]
        out[k] = q[column] if column >= 0 else 0.0
    if springs.kind[f] == TORSION:
        arm = springs.rows[f, 1]
        out[0] = springs.rows[f, 0] - arm + arm * math.cos(out[2])
        out[1] = arm * math.sin(out[2])
    else:
        out[0] += springs.rows[f, 0]


@kernel(**OPTIONS)
def margin(springs, f, pose, gradient):
    """Distance to the validity limit: the smallest of 1 - |theta| / limit, 1 - |force - middle| / half range on either
    base axis, and for a potential its buckling guard over the guard at rest. 1 in the middle, 0 on the limit, negative
    outside."""
    least = 1 - abs(pose[2]) / springs.box[f, 0]
    if springs.kind[f] != TORSION:  # a pin carries any force
        for i in range(2):
            least = min(least, 1 - abs(gradient[i] - springs.box[f, 1 + i]) / springs.box[f, 3 + i])
    if springs.kind[f] == POTENTIAL:
        rows, scales = springs.coefficients[f], springs.rows[f]
        guard = potential_kernel.pose(rows, scales, pose[2], gradient[0], gradient[1])[4]
        least = min(least, guard / rows[potential_kernel.SK, 0] ** 2)
    return least


@kernel(**OPTIONS)
def all_springs(springs, q, first, force, stiffness):
    """Gradients and Hessians of every joint at q, in the columns of the whole robot: force (n,), stiffness (n, n).

    Returns their energy [J].
    """
    pose, gradient, hessian = np.empty(6), np.empty(6), np.empty((6, 6))
    force[:], stiffness[:], energy = 0.0, 0.0, 0.0
    for f in range(len(springs.kind)):
        pose_of(springs, f, q, pose)
        energy += spring(springs, f, pose, gradient, hessian)
        for i in range(6):
            row = springs.columns[f, i]
            if row < 0:
                continue
            force[first + row] = gradient[i]
            for j in range(6):
                if springs.columns[f, j] >= 0:
                    stiffness[first + row, first + springs.columns[f, j]] = hessian[i, j]
    return energy


@kernel(**OPTIONS)
def damping(springs, q, first, out):
    """B (n, n) = loss time x K(q), of a Kelvin-Voigt material; negative stiffnesses, of pre-stress, take no part."""
    pose, gradient, hessian = np.empty(6), np.empty(6), np.empty((6, 6))
    out[:] = 0.0
    for f in range(len(springs.kind)):
        if springs.loss_time[f] == 0.0:
            continue
        pose_of(springs, f, q, pose)
        spring(springs, f, pose, gradient, hessian)
        values, axes = np.linalg.eigh(hessian)
        positive = springs.loss_time[f] * (axes * np.maximum(values, 0.0)) @ np.ascontiguousarray(axes.T)
        for i in range(6):
            for j in range(6):
                if springs.columns[f, i] >= 0 and springs.columns[f, j] >= 0:
                    out[first + springs.columns[f, i], first + springs.columns[f, j]] = positive[i, j]
