"""Travel: what a designer looks at along a hinge's travel: stiffness in and out of plane, stress, buckling."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Hinge, States

from .equilibrium import arm_direction, rotate
from .mesh import ELEMENTS, mesh_of
from .out_of_plane import out_of_plane_stiffness
from .path import CONVERGED
from .push import push
from .solution import Solution
from .stress import Stress, largest_stress
from .tangent import load_factor, memory_at, tip_stiffness

Y, TURN = 1, 2


@dataclass(frozen=True)
class Travel:
    """n states of one path from rest, and what holds at each."""

    states: States
    driven: int
    """Which of x, y, turn is driven along the path: Y or TURN."""
    stiffness: FloatArray
    """(n, 3, 3) wrench over the tip's x, y [m] and turn [rad]."""
    out_of_plane: FloatArray
    """(n, 3, 3) force z and moments about x, y over z [m] and turns about x, y [rad]: an approximation."""
    stress: tuple[Stress, ...]
    """n largest stresses of the extreme fibre."""
    load_factor: FloatArray
    """(n,) by what the state's loads may grow before it buckles; infinite where nothing buckles."""

    @property
    def drive_stiffness(self) -> FloatArray:
        """(n,) force or moment over the driven freedom, the others free [N/m or N m/rad]."""
        return np.asarray(1 / np.linalg.inv(self.stiffness)[:, self.driven, self.driven])

    def support_stiffness(self, freedom: int) -> FloatArray:
        """(n,) force or moment over another freedom, the driven one held, the third free [N/m or N m/rad]."""
        rest = [i for i in range(3) if i != self.driven]
        held = np.linalg.inv(self.stiffness[:, rest][:, :, rest])
        place = rest.index(freedom)
        return np.asarray(1 / held[:, place, place])

    def out_of_plane_free(self) -> FloatArray:
        """(n, 3) z [N/m], about x and about y [N m/rad], each with the other two free."""
        return np.asarray(1 / np.linalg.inv(self.out_of_plane).diagonal(axis1=1, axis2=2))


def turned(hinge: Hinge, theta: FloatArray, *, axial: float = 0.0, elements: int = ELEMENTS) -> Travel:
    """Along turns of the tip by a force across the end of the arm; by a pure moment without one.

    Args:
        hinge: its ``arm`` is the lever.
        theta: (n,) [rad], from rest on.
        axial: dead force along x at the tip besides [N].
        elements: of a leaf as long as the hinge.

    Raises:
        FlexureError: where the hinge cannot be turned that far.
    """
    direction = arm_direction(theta, hinge.arm) if hinge.arm else (0.0, 0.0, 1.0)
    solution = rotate(hinge, theta, force=(axial, 0.0), direction=direction, elements=elements, keep_nodes=True)
    bad = np.flatnonzero(solution.status != CONVERGED)
    if len(bad):
        raise FlexureError(f"{hinge.name}: turned towards {np.degrees(theta[bad[0]]):.3g} deg it "
                           f"{solution.reason(int(bad[0]))}; lower max_angle or the axial force")  # fmt: skip
    return along(hinge, solution, TURN, hinge.arm * np.sin(theta) * solution.force[:, 1], elements)


def pushed(hinge: Hinge, travel: FloatArray, *, axial: float = 0.0, elements: int = ELEMENTS) -> Travel:
    """Along travels (n,) [m] of the tip under a force in y, as ``push``."""
    solution = push(hinge, travel, axial=axial, elements=elements)
    return along(hinge, solution, Y, elements=elements)


def along(hinge: Hinge, solution: Solution, driven: int, lever: FloatArray | float = 0.0,
          elements: int = ELEMENTS) -> Travel:  # fmt: skip
    """Along converged states whose nodes were kept.

    Args:
        hinge, solution: what was solved.
        driven: Y or TURN.
        lever: (n,) as ``load_factor`` takes it [N m].
        elements: those it was solved with.
    """
    mesh, levers = mesh_of(hinge, elements), np.broadcast_to(lever, len(solution.theta))
    inside, outside, stress, factors = [], [], [], []
    for i in range(len(solution.theta)):
        mem = memory_at(mesh, solution, i)
        inside.append(tip_stiffness(mesh, mem))
        outside.append(out_of_plane_stiffness(hinge, mesh, mem))
        stress.append(largest_stress(hinge, mesh, mem))
        factors.append(load_factor(mesh, mem, float(levers[i])))
    return Travel(solution.states(), driven, np.array(inside), np.array(outside), tuple(stress), np.array(factors))
