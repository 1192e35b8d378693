"""Statics of a robot on a face, apart from any engine: nodes where springs, weight and ground have least energy.

Unknown are the rods' middles and directions and the payload's centre. Cables pull only, rods are straight and rigid,
the ground is a stiff spring under every foot. Friction has no energy, so it is bracketed: ground without any, and
ground that grips the feet that stand on it at first.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize

from tensegym.arrays import FloatArray, IntArray
from tensegym.design.design import RobotDesign
from tensegym.design.groups import column
from tensegym.structure.faces import resting_rotation

GROUND = 1e4  # weights over lengths: the stiffness of the ground, and of its grip


def lowest_energy(design: RobotDesign, triangle: IntArray, grip: bool) -> FloatArray:
    """(n, 3) nodes [m] at the least energy that is found downhill from the robot standing on a hull triangle."""
    structure, payload, rods = design.standing, design.payload, design.standing.rods
    turn = resting_rotation(structure.nodes, triangle)
    nodes, count, half = structure.nodes @ turn.T, len(rods), structure.rod_lengths[:, None] / 2
    radius = np.zeros(len(nodes))
    for rod, ends in enumerate(rods):
        radius[ends] = max(design.rod(rod).foot_radius, design.rod(rod).tube_outer_radius)
    nodes[:, 2] -= (nodes[:, 2] - radius).min()
    middles, centre = nodes[rods].mean(axis=1), nodes[rods].mean(axis=(0, 1))
    weights = np.array([design.rod(rod).mass for rod in range(count)]) * design.gravity
    ground = GROUND * design.mass * design.gravity / design.length
    standing = np.flatnonzero(nodes[:, 2] - radius < 1e-6) if grip else np.zeros(0, dtype=int)
    held, first = nodes[standing, :2].copy(), nodes
    pairs, natural = structure.cables, design.cable_natural_lengths + 2 * design.attachment_radius
    stiffness, two_way = column(design.each_cable, "stiffness"), column(design.each_cable, "two_way") > 0
    outward = (middles - centre) / np.linalg.norm(middles - centre, axis=1)[:, None]

    def shape(unknown: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        rows = unknown.reshape(-1, 3)
        sizes = np.linalg.norm(rows[count : 2 * count], axis=1)[:, None]
        axes, mids = rows[count : 2 * count] / sizes, rows[:count]
        nodes = np.empty_like(first)
        nodes[rods[:, 0]], nodes[rods[:, 1]] = mids - half * axes, mids + half * axes
        return nodes, mids, axes, sizes, rows[-1]

    def energy(unknown: FloatArray) -> tuple[float, FloatArray]:
        nodes, mids, axes, sizes, ball = shape(unknown)
        force = np.zeros_like(nodes)  # gradients by the nodes, the middles and the payload
        of_mids, of_ball = np.zeros_like(mids), np.zeros(3)
        spans = nodes[pairs[:, 1]] - nodes[pairs[:, 0]]
        lengths = np.linalg.norm(spans, axis=1)
        stretch = np.where(two_way, lengths - natural, np.maximum(lengths - natural, 0))
        pull = (stiffness * stretch / lengths)[:, None] * spans
        np.add.at(force, pairs[:, 1], pull)
        np.add.at(force, pairs[:, 0], -pull)
        total = 0.5 * float(stiffness @ stretch**2) + float(weights @ mids[:, 2])
        of_mids[:, 2] += weights
        under = np.maximum(radius - nodes[:, 2], 0)
        total += 0.5 * ground * float(under @ under)
        force[:, 2] -= ground * under
        slid = nodes[standing, :2] - held
        total += 0.5 * ground * float((slid**2).sum())
        force[standing, :2] += ground * slid
        if payload:
            spans = ball + payload.radius * outward - mids
            lengths = np.linalg.norm(spans, axis=1)
            stretch = lengths - design.payload_natural_length
            stretch = stretch if payload.two_way else np.maximum(stretch, 0)
            pull = (payload.stiffness * stretch / lengths)[:, None] * spans
            below = max(payload.radius - ball[2], 0.0)
            total += 0.5 * payload.stiffness * float(stretch @ stretch) + 0.5 * ground * below**2
            total += payload.mass * design.gravity * ball[2]
            of_mids -= pull
            of_ball += pull.sum(axis=0)
            of_ball[2] += payload.mass * design.gravity - ground * below
        a, b = force[rods[:, 0]], force[rods[:, 1]]
        across = half * (b - a)
        across = (across - (across * axes).sum(axis=1)[:, None] * axes) / sizes
        return total, np.concatenate([of_mids + a + b, across, of_ball[None] if payload else np.zeros((0, 3))]).ravel()

    start = np.concatenate([middles, (nodes[rods[:, 1]] - nodes[rods[:, 0]]) / (2 * half),
                            centre[None] if payload else np.zeros((0, 3))])  # fmt: skip
    options = {"maxiter": 20_000, "maxfun": 40_000, "maxcor": 40, "ftol": 1e-13, "gtol": 1e-7}
    found = minimize(energy, start.ravel(), jac=True, method="L-BFGS-B", options=options)
    return shape(found.x)[0]
