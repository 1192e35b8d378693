"""One time step of a robot with flexure joints: the forces that make PyBullet take a trapezoidal step, compiled.

PyBullet steps v' = v + dt a, q' = q + dt v' from forces at the state it has: leapfrog, with v half a step behind q. It
is unstable where a spring's frequency w passes 2/dt, and evaluates velocity terms half a step early. Here the force is

    f = -1/4 (g(q - dt v) + 2 g(q) + g(q + dt v + dt^2 a)) - B (v + dt a),     g the gradient of the springs' energy
    M(q) a + h(q, v + dt a / 2) = f + known forces

the average acceleration method (Newmark 1959, beta = 1/4, gamma = 1/2; the trapezoidal rule): second order, symmetric
in time, without numerical damping, and stable for any linear spring. a is found by Newton's method with
the matrix M + dt^2/4 K + dt B. Damping takes the velocity at the end of the step: at its middle it would not see the
fastest modes, which alternate from step to step and would ring on; the price is an inertia of dt/2 B.

The engine solves for contact forces after that. A stiff spring would take a foot for free in the step that stops it,
and be strained by the whole way of the rest of the robot in that step; so contacts are foreseen (contacts.py): a term
-(H a + stop) with H = rho J^T J, rho far over the robot's mass, stands for their force in the equation of a.
"""

from __future__ import annotations

import numpy as np

from tensegym.compiled import kernel
from tensegym.flexure.fem.beam import OPTIONS

from .spring_kernel import all_springs, damping, margin, pose_of, spring
from .tree_kernel import bias, frames, generalised, mass_matrix, point_velocity

EXPLICIT, TRAPEZOID = 0, 1
MOST_ITERATIONS, TOLERANCE = 40, 1e-13  # of Newton; change of a coordinate in one step [m, rad]


@kernel(**OPTIONS)
def step_forces(tree, springs, base, q, v, known, drag, hold, stop, gravity, dt, scheme, most, a, out, margins):
    """Generalised forces out (n,) for PyBullet's next step, and the acceleration a (n,) it will give.

    base (7,), q (j,), v (n,) as the engine has them; known (n,) the other forces, which the caller gives to the engine;
    drag (j,) viscous damping of the joints; hold (n, n) and stop (n,) as above; ``most`` Newton iterations; margins
    (f,) see spring_kernel.margin.
    Returns the iterations, or -1 when they do not converge.
    """
    n, size, first = len(v), len(tree.parent), tree.first
    turns, origins = np.empty((size, 3, 3)), np.empty((size, 3))
    centres, axes = np.empty((size, 3)), np.empty((size, 3))
    frames(tree, base, q, turns, origins, centres, axes)
    mass, early, middle = np.empty((n, n)), np.empty(n), np.empty(n)
    mass_matrix(tree, turns, origins, centres, axes, mass)
    bias(tree, v, gravity, turns, origins, centres, axes, early)
    now, other, stiffness, loss = np.empty(n), np.empty(n), np.empty((n, n)), np.empty((n, n))
    all_springs(springs, q, first, now, stiffness)
    damping(springs, q, first, loss)
    for j in range(len(q)):
        loss[first + j, first + j] += drag[j]
    _margins(springs, q, margins)
    if scheme == EXPLICIT:
        out[:] = -now - loss @ v
        a[:] = np.linalg.solve(mass + hold, known + out - early - stop)
        return 1
    all_springs(springs, q - dt * v[first:], first, other, stiffness)
    past = 0.25 * other + 0.5 * now
    last, change = np.inf, np.zeros(n)
    for iteration in range(1, most + 1):
        mean = v + 0.5 * dt * a
        bias(tree, mean, gravity, turns, origins, centres, axes, middle)
        all_springs(springs, q + dt * (v[first:] + dt * a[first:]), first, other, stiffness)
        out[:] = -past - 0.25 * other - loss @ (v + dt * a)
        miss = out + known - middle - mass @ a - hold @ a - stop
        size_of = np.sqrt((miss * miss).sum())
        if size_of > 2 * last and iteration < most // 2:  # the last change overshot: half of it
            change *= 0.5
            a -= change
            continue
        last = size_of
        change = np.linalg.solve(mass + hold + 0.25 * dt * dt * stiffness + dt * loss, miss)
        a += change
        # to the force of the new a, to first order: what is left is of the square of the change
        out -= 0.25 * dt * dt * stiffness @ change + dt * loss @ change
        size_of = dt * dt * np.abs(change).max()
        if not np.isfinite(size_of):
            return -1
        if size_of < TOLERANCE or most == 1:
            out += early - middle
            return iteration
    return -1


@kernel(**OPTIONS)
def _margins(springs, q, out):
    pose, gradient, hessian = np.empty(6), np.empty(6), np.empty((6, 6))
    for f in range(len(springs.kind)):
        pose_of(springs, f, q, pose)
        spring(springs, f, pose, gradient, hessian)
        out[f] = margin(springs, f, pose, gradient)


@kernel(**OPTIONS)
def add_load(tree, base, q, link, force, point, torque, out):
    """Add to out (n,) a force [N] and torque [N m], world axes, at a point of a link in its own frame [m]; returns the
    point in the world."""
    size = len(tree.parent)
    turns, origins = np.empty((size, 3, 3)), np.empty((size, 3))
    centres, axes = np.empty((size, 3)), np.empty((size, 3))
    frames(tree, base, q, turns, origins, centres, axes)
    place = origins[link] + turns[link] @ point
    generalised(tree, link, place, force, torque, origins, centres, axes, out)
    return place


@kernel(**OPTIONS)
def kinetic_and_gravity(tree, base, q, v, gravity):
    """Kinetic energy and that of gravity, zero with every centre at the world's origin [J]."""
    size, n = len(tree.parent), len(v)
    turns, origins = np.empty((size, 3, 3)), np.empty((size, 3))
    centres, axes = np.empty((size, 3)), np.empty((size, 3))
    frames(tree, base, q, turns, origins, centres, axes)
    mass = np.empty((n, n))
    mass_matrix(tree, turns, origins, centres, axes, mass)
    weight = 0.0
    for i in range(size):
        weight -= tree.mass[i] * (centres[i] @ gravity)
    return 0.5 * v @ (mass @ v), weight


@kernel(**OPTIONS)
def momentum(tree, base, q, v):
    """(6,) linear and angular momentum about the world's origin, world axes."""
    size = len(tree.parent)
    turns, origins = np.empty((size, 3, 3)), np.empty((size, 3))
    centres, axes = np.empty((size, 3)), np.empty((size, 3))
    frames(tree, base, q, turns, origins, centres, axes)
    out, linear, angular = np.zeros(6), np.empty(3), np.empty(3)
    for i in range(size):
        point_velocity(tree, i, centres[i], v, origins, centres, axes, linear, angular)
        out[:3] += tree.mass[i] * linear
        out[3:] += tree.mass[i] * np.cross(centres[i], linear)
        out[3:] += (turns[i] @ tree.inertia[i] @ turns[i].T) @ angular
    return out
