"""What the prestress makes of a structure: how far form finding moved it, whether it is flat, whether it holds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import null_space

from tensegym.arrays import FloatArray
from tensegym.errors import ShapeError
from tensegym.structure.equilibrium import equilibrium_matrix, in_words, members
from tensegym.structure.rod_balance import cross_matrices
from tensegym.structure.structure import Structure

FLAT = 0.01  # of the longest rod: a structure thinner than this is a plane figure
UNSTABLE = 1e-4  # of the tension over the longest rod: a motion that loses more stiffness than this runs away


class Shape(NamedTuple):
    """A structure at rest under its prestress, without weight."""

    moved: float
    """Largest distance from a given node to where form finding put it, after the best rigid motion [m]."""
    thickness: float
    """Extent of the nodes along the principal axis on which they spread least [m]."""
    flattened: bool
    """Whether form finding made a plane figure of nodes that are none."""
    least_stiffness: float
    """Least eigenvalue of the tangent stiffness over motions of rigid rods, rigid motions of the whole left out: energy
    to second order over half the sum of the squared displacements of the nodes [N/m]. Below 0 the shape is a saddle.
    NaN where the prestress is not in balance at rest, as with a given natural length."""
    mode: FloatArray
    """(n, 3) displacements of the nodes in that motion, the largest of length 1."""


def thickness(nodes: FloatArray) -> float:
    """Extent of nodes (n, 3) along the principal axis on which they spread least [m]."""
    centred = nodes - nodes.mean(axis=0)
    return float(np.ptp(centred @ np.linalg.svd(centred, full_matrices=False)[2][-1]))


def shape_of(
    given: Structure, standing: Structure, tension: FloatArray, stiffness: FloatArray, radius: float
) -> Shape:
    """The shape that form finding made of ``given``.

    Args:
        given, standing: before and after; the same where the nodes balance as given.
        tension: (c,) of the elastic cables at rest [N]; NaN where they are not in balance.
        stiffness: (c,) of the elastic cables [N/m].
        radius: cables are tied this far from their nodes, on the line between them [m].
    """
    moved = float(np.linalg.norm(standing.nodes - given.nodes, axis=1).max())
    thin, limit = thickness(standing.nodes), FLAT * float(standing.rod_lengths.max())
    flattened = thin < limit <= thickness(given.nodes)
    if not (tension > 0).any() or np.isnan(tension).any():
        return Shape(moved, thin, flattened, float("nan"), np.zeros_like(standing.nodes))
    if len(standing.shared):
        least, mode = node_stiffness(standing, tension, stiffness)
    else:
        least, mode = least_stiffness(standing, tension, stiffness, radius)
    return Shape(moved, thin, flattened, least, mode)


def check_shape(shape: Shape, standing: Structure, tension: FloatArray) -> None:
    """Raise ShapeError for a robot that cannot be what its design says: a plane figure, or a saddle."""
    if shape.flattened:
        raise ShapeError(
            f"structure: form finding flattens these nodes to a plane figure, {1e3 * shape.thickness:.2g} mm thick: "
            "equal tension in all cables holds no body near them. Change the cables or the proportions"
        )
    softest = UNSTABLE * tension.max(initial=0.0) / standing.rod_lengths.max()
    if shape.least_stiffness < -softest:
        raise ShapeError(
            f"structure: {in_words(tension)} balances these nodes but does not hold them: stiffness "
            f"{shape.least_stiffness:.3g} N/m, below 0, along a motion of nodes {_most_moved(shape.mode)}. "
            "Change the cables or the nodes"
        )


def _most_moved(mode: FloatArray) -> str:
    return ", ".join(str(node + 1) for node in np.argsort(-np.linalg.norm(mode, axis=1), kind="stable")[:3])


def least_stiffness(
    structure: Structure, tension: ArrayLike, stiffness: ArrayLike, radius: float
) -> tuple[float, FloatArray]:
    """Least stiffness of rigid rods between prestressed cables [N/m], and its mode (n, 3); see Shape.

    Each rod moves by its middle's displacement and a turn w across its axis or about it. A cable of span l u resists
    with k u u^T + (T / l)(1 - u u^T); to second order a turn moves a point p of a rod, pulled by a force f, by
    w x (w x p) / 2, which takes the energy -(f . w)(p . w) / 2 + (f . p) w^2 / 2.
    """
    nodes, rods, cables = structure.nodes, structure.rods, structure.cables
    count, half = len(rods), structure.rod_lengths / 2
    tension, stiffness = (np.broadcast_to(np.asarray(a, dtype=float), len(cables)) for a in (tension, stiffness))
    rod_of = np.empty(len(nodes), dtype=np.int64)
    rod_of[rods] = np.arange(count)[:, None]
    arms = nodes - nodes[rods].mean(axis=1)[rod_of]
    spans = nodes[cables[:, 1]] - nodes[cables[:, 0]]
    along = spans / np.linalg.norm(spans, axis=1)[:, None]
    free = np.linalg.norm(spans, axis=1) - 2 * radius
    block = along[:, :, None] * along[:, None, :] * (stiffness - tension / free)[:, None, None]
    block += (tension / free)[:, None, None] * np.eye(3)

    change = np.zeros((len(cables), 3, count, 6))  # of a cable's span, per middle's displacement and turn times half
    turning = np.zeros((count, 3, 3))
    rows = np.arange(len(cables))
    for side, sign in ((0, -1.0), (1, 1.0)):
        end = cables[:, side]
        rod, tie, pull = rod_of[end], arms[end] - sign * radius * along, -sign * tension[:, None] * along
        change[rows, :, rod, :3] += sign * np.eye(3)
        change[rows, :, rod, 3:] -= sign * cross_matrices(tie) / half[rod, None, None]
        turned = (pull * tie).sum(axis=1)[:, None, None] * np.eye(3)
        turned -= (pull[:, :, None] * tie[:, None, :] + tie[:, :, None] * pull[:, None, :]) / 2
        np.add.at(turning, rod, turned / half[rod, None, None] ** 2)
    matrix, every = np.zeros((count, 6, count, 6)), np.arange(count)
    matrix[every, 3:, every, 3:] = turning
    jacobian = change.reshape(len(cables), 3, -1)
    full = matrix.reshape(6 * count, -1) + np.einsum("cik,cij,cjl->kl", jacobian, block, jacobian, optimize=True)

    to_nodes = np.zeros((len(nodes), 3, count, 6))
    ends = np.arange(len(nodes))
    to_nodes[ends, :, rod_of, :3] = np.eye(3)
    to_nodes[ends, :, rod_of, 3:] = -cross_matrices(arms) / half[rod_of, None, None]
    shift = to_nodes.reshape(3 * len(nodes), -1)
    # motions of nodes: the spins, which move none, and the whole robot's rigid motions are taken out
    _, values, right = np.linalg.svd(shift, full_matrices=False)
    basis = right[values > 1e-9 * values[0]].T / values[values > 1e-9 * values[0]]
    centred = nodes - nodes.mean(axis=0)
    rigid = np.concatenate([np.tile(np.eye(3), (len(nodes), 1)), -cross_matrices(centred).reshape(-1, 3)], axis=1)
    left, sizes, _ = np.linalg.svd(basis.T @ (shift.T @ rigid))
    other = left[:, int((sizes > 1e-9 * sizes[0]).sum()) :]
    held, spins = basis @ other, right[values <= 1e-9 * values[0]].T
    if not held.shape[1]:
        return float("nan"), np.zeros_like(nodes)
    reduced = held.T @ full @ held
    if radius:  # cables tied beside the axis hold the spins, which follow the other motions
        coupling = spins.T @ full @ held
        reduced -= coupling.T @ np.linalg.lstsq(spins.T @ full @ spins, coupling, rcond=1e-9)[0]
    stiff, vectors = np.linalg.eigh(reduced)
    mode = (shift @ (held @ vectors[:, 0])).reshape(-1, 3)
    return float(stiff[0]), mode / np.linalg.norm(mode, axis=1).max()


def node_stiffness(structure: Structure, tension: ArrayLike, stiffness: ArrayLike) -> tuple[float, FloatArray]:
    """`least_stiffness` of cables that end on the nodes, for rods that may share these.

    Members of force density q resist with q times the difference of their ends' displacements, cables also with
    (k - q) u u^T, over the displacements that keep the rods' lengths (Guest 2006, "The stiffness of prestressed
    frameworks: a unifying approach").
    """
    matrix, cables = equilibrium_matrix(structure), len(structure.cables)
    pairs = members(structure)
    lengths = structure.lengths(pairs)
    tension, stiffness = (np.broadcast_to(np.asarray(a, dtype=float), cables) for a in (tension, stiffness))
    densities = np.concatenate([tension / lengths[:cables], np.zeros(len(structure.rods))])
    densities[cables:] = np.linalg.lstsq(matrix[:, cables:], -matrix @ densities, rcond=None)[0]
    ends = np.zeros((len(pairs), len(structure.nodes)))
    ends[np.arange(len(pairs)), pairs[:, 0]], ends[np.arange(len(pairs)), pairs[:, 1]] = -1.0, 1.0
    stretch = matrix / lengths  # of members, for unit displacements, with the sign turned
    along = stretch[:, :cables] * (stiffness - densities[:cables])
    full = np.kron(ends.T @ (densities[:, None] * ends), np.eye(3)) + along @ stretch[:, :cables].T
    centred = structure.nodes - structure.nodes.mean(axis=0)
    rigid = np.concatenate([np.tile(np.eye(3), (len(centred), 1)), -cross_matrices(centred).reshape(-1, 3)], axis=1)
    held = null_space(np.concatenate([stretch[:, cables:].T, rigid.T]), rcond=1e-9)
    if not held.shape[1]:
        return float("nan"), np.zeros_like(structure.nodes)
    values, vectors = np.linalg.eigh(held.T @ full @ held)
    mode = (held @ vectors[:, 0]).reshape(-1, 3)
    return float(values[0]), mode / np.linalg.norm(mode, axis=1).max()
