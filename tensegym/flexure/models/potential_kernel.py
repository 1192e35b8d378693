"""The potential's wrench, stiffness and pose under a load, compiled. Units: see ``Potential``.

In units of the joint (u = theta / theta0, lengths over L, energies over M0, forces over M0 / L), with
e = R(-theta/2) p, X = e_x - 1 - rho(u), Y = e_y - sigma(u):

    V = 1/2 u^2 su^2 + (X - h Y - g Y^2)^2 / (2 C) + 1/2 K Y^2,   K = sk^2,  C = sa^2 + u^2 sb^2

su, sk, sa, sb, rho, sigma, h, g are polynomials in u: rows of ``coefficients`` (8, degree + 1), lowest power first;
rho and sigma have no constant. A hinge that is symmetric both ways has even su, sk, sa, sb, rho, g and no sigma, h.
"""

from __future__ import annotations

import math

import numpy as np

from tensegym.compiled import kernel
from tensegym.flexure.fem.beam import OPTIONS

SU, SK, SA, SB, RHO, SIGMA, H, G = range(8)
NAMES = ("su", "sk", "sa", "sb", "rho", "sigma", "h", "g")


@kernel(**OPTIONS)
def horner(row, u):
    """Value, first and second derivative of a polynomial."""
    value, slope, curve = 0.0, 0.0, 0.0
    for i in range(len(row) - 1, -1, -1):
        curve = curve * u + slope
        slope = slope * u + value
        value = value * u + row[i]
    return value, slope, 2 * curve


@kernel(**OPTIONS)
def at_angle(coefficients, u):
    """su, sk, C, rho, sigma, h, g at u, then their slopes in that order."""
    su, su1, _ = horner(coefficients[SU], u)
    sk, sk1, _ = horner(coefficients[SK], u)
    sa, sa1, _ = horner(coefficients[SA], u)
    sb, sb1, _ = horner(coefficients[SB], u)
    rho, rho1, _ = horner(coefficients[RHO], u)
    sig, sig1, _ = horner(coefficients[SIGMA], u)
    h, h1, _ = horner(coefficients[H], u)
    g, g1, _ = horner(coefficients[G], u)
    soft = sa * sa + u * u * sb * sb
    soft1 = 2 * (sa * sa1 + u * sb * sb + u * u * sb * sb1)
    return su, sk, soft, rho, sig, h, g, su1, sk1, soft1, rho1, sig1, h1, g1


@kernel(**OPTIONS)
def slope_over_u(at, u, n, p, big_y):
    """dV/du at a fixed e in units of M0; at: of at_angle; n, p: the force in the axes turned by theta / 2; Y."""
    su, sk, _, _, _, _, _, su1, sk1, soft1, rho1, sig1, h1, g1 = at
    return (su * (u * su + u * u * su1) - n * (rho1 + (h1 + g1 * big_y) * big_y) - 0.5 * soft1 * n * n
            + sk * sk1 * big_y * big_y - sig1 * p)  # fmt: skip


@kernel(**OPTIONS)
def wrench(coefficients, scales, x, y, theta):
    """Force x, y [N] in base axes and moment [N m] about the tip that hold it at (x, y) [m], theta; energy [J]."""
    length, moment0, theta0 = scales[0], scales[1], scales[2]
    u = theta / theta0
    at = at_angle(coefficients, u)
    su, sk, soft, rho, sig, h, g = at[:7]
    c, s = math.cos(theta / 2), math.sin(theta / 2)
    ex, ey = (c * x + s * y) / length, (c * y - s * x) / length
    big_y = ey - sig
    stretch = ex - 1 - rho - (h + g * big_y) * big_y
    n = stretch / soft
    k = sk * sk
    p = k * big_y - n * (h + 2 * g * big_y)
    m = slope_over_u(at, u, n, p, big_y) / theta0 + 0.5 * (n * ey - p * ex)
    force = moment0 / length
    energy = moment0 * 0.5 * (u * u * su * su + stretch * n + k * big_y * big_y)
    return force * (c * n - s * p), force * (s * n + c * p), moment0 * m, energy


@kernel(**OPTIONS)
def stiffness(coefficients, scales, x, y, theta, out):
    """Jacobian of the wrench over (x, y, theta) into out (3, 3), symmetric; returns the wrench and the energy."""
    length, moment0, theta0 = scales[0], scales[1], scales[2]
    u = theta / theta0
    su, su1, su2 = horner(coefficients[SU], u)
    sk, sk1, sk2 = horner(coefficients[SK], u)
    sa, sa1, sa2 = horner(coefficients[SA], u)
    sb, sb1, sb2 = horner(coefficients[SB], u)
    rho, rho1, rho2 = horner(coefficients[RHO], u)
    sig, sig1, sig2 = horner(coefficients[SIGMA], u)
    h, h1, h2 = horner(coefficients[H], u)
    g, g1, g2 = horner(coefficients[G], u)
    c, s = math.cos(theta / 2), math.sin(theta / 2)
    ex, ey = (c * x + s * y) / length, (c * y - s * x) / length
    # q = X - h Y - g Y^2 and its derivatives over (ex, ey, u) at fixed e
    yy = ey - sig
    q = ex - 1 - rho - (h + g * yy) * yy
    slope = h + 2 * g * yy
    slope1 = h1 + 2 * g1 * yy - 2 * g * sig1
    qy = -slope
    qu = -rho1 - (h1 + g1 * yy) * yy + slope * sig1
    qyy = -2 * g
    qyu = -slope1
    quu = -rho2 - (h2 + g2 * yy) * yy + (h1 + 2 * g1 * yy) * sig1 + slope1 * sig1 + slope * sig2
    soft = sa * sa + u * u * sb * sb
    soft1 = 2 * (sa * sa1 + u * sb * sb + u * u * sb * sb1)
    soft2 = 2 * (sa1 * sa1 + sa * sa2 + sb * sb + 4 * u * sb * sb1 + u * u * (sb1 * sb1 + sb * sb2))
    k, k1, k2 = sk * sk, 2 * sk * sk1, 2 * (sk1 * sk1 + sk * sk2)
    n = q / soft
    b0 = u * su  # U = b0^2 / 2
    b1, b2 = su + u * su1, 2 * su1 + u * su2
    vx, vy = n, n * qy + k * yy
    vu = b0 * b1 + n * qu - 0.5 * soft1 * n * n + 0.5 * k1 * yy * yy - k * yy * sig1
    nu = (qu - soft1 * n) / soft  # derivative of n over u
    vxx, vxy, vxu = 1 / soft, qy / soft, nu
    vyy = qy * qy / soft + n * qyy + k
    vyu = nu * qy + n * qyu + k1 * yy - k * sig1
    vuu = (b1 * b1 + b0 * b2 + nu * qu + n * quu - 0.5 * soft2 * n * n - soft1 * n * nu + 0.5 * k2 * yy * yy
           - 2 * k1 * yy * sig1 + k * sig1 * sig1 - k * yy * sig2)  # fmt: skip
    # over theta at fixed p: d e / d theta = (ey, -ex) / 2, and (vx, vy) turned back into base axes
    vxt = vxu / theta0 + 0.5 * (vxx * ey - vxy * ex)
    vyt = vyu / theta0 + 0.5 * (vxy * ey - vyy * ex)
    # d/dtheta of m = vu / theta0 + (vx ey - vy ex)/2
    vut = vuu / theta0 + 0.5 * (vxu * ey - vyu * ex)
    m = vu / theta0 + 0.5 * (vx * ey - vy * ex)
    mt = vut / theta0 + 0.5 * (vxt * ey - vyt * ex - 0.5 * vx * ex - 0.5 * vy * ey)
    # force in base axes f = R(theta/2) (vx, vy): df/dtheta = R ((vxt, vyt) + J (vx, vy) / 2)
    tx, ty = vxt - 0.5 * vy, vyt + 0.5 * vx
    force = moment0 / length
    rigid = force / length
    out[0, 0] = rigid * (c * c * vxx - 2 * c * s * vxy + s * s * vyy)
    out[0, 1] = rigid * (c * s * (vxx - vyy) + (c * c - s * s) * vxy)
    out[1, 1] = rigid * (s * s * vxx + 2 * c * s * vxy + c * c * vyy)
    out[0, 2], out[1, 2], out[2, 2] = force * (c * tx - s * ty), force * (s * tx + c * ty), moment0 * mt
    out[1, 0], out[2, 0], out[2, 1] = out[0, 1], out[0, 2], out[1, 2]
    energy = moment0 * 0.5 * (b0 * b0 + q * n + k * yy * yy)
    return force * (c * vx - s * vy), force * (s * vx + c * vy), moment0 * m, energy


@kernel(**OPTIONS)
def pose(coefficients, scales, theta, fx, fy):
    """Tip x, y [m] and the moment [N m] under the dead force (fx, fy) [N] at theta, explicit; energy; K - 2 g n."""
    length, moment0, theta0 = scales[0], scales[1], scales[2]
    u = theta / theta0
    at = at_angle(coefficients, u)
    su, sk, soft, rho, sig, h, g = at[:7]
    c, s = math.cos(theta / 2), math.sin(theta / 2)
    scale = length / moment0
    n, p = scale * (c * fx + s * fy), scale * (c * fy - s * fx)
    k = sk * sk
    guard = k - 2 * g * n
    big_y = (p + n * h) / guard
    ex = 1 + rho + soft * n + (h + g * big_y) * big_y
    ey = sig + big_y
    m = slope_over_u(at, u, n, p, big_y) / theta0 + 0.5 * (n * ey - p * ex)
    energy = moment0 * 0.5 * (u * u * su * su + soft * n * n + k * big_y * big_y)
    return length * (c * ex - s * ey), length * (s * ex + c * ey), moment0 * m, energy, guard


@kernel(**OPTIONS)
def wrench_batch(coefficients, scales, poses):
    """(n, 3) wrenches of (n, 3) poses x, y, theta, and (n,) energies."""
    out, energy = np.empty((len(poses), 3)), np.empty(len(poses))
    for i in range(len(poses)):
        out[i, 0], out[i, 1], out[i, 2], energy[i] = wrench(coefficients, scales, poses[i, 0], poses[i, 1], poses[i, 2])
    return out, energy


@kernel(**OPTIONS)
def stiffness_batch(coefficients, scales, poses):
    """(n, 3, 3) stiffness of (n, 3) poses x, y, theta."""
    out = np.empty((len(poses), 3, 3))
    for i in range(len(poses)):
        stiffness(coefficients, scales, poses[i, 0], poses[i, 1], poses[i, 2], out[i])
    return out


@kernel(**OPTIONS)
def pose_batch(coefficients, scales, theta, force):
    """(n, 5) tip x, y, moment, energy and K - 2 g n at theta (n,) under force (n, 2)."""
    out = np.empty((len(theta), 5))
    for i in range(len(theta)):
        out[i, 0], out[i, 1], out[i, 2], out[i, 3], out[i, 4] = pose(coefficients, scales, theta[i], force[i, 0],
                                                                     force[i, 1])  # fmt: skip
    return out
