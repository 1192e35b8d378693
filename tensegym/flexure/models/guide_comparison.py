"""A parallelogram by every model: what each misses of the FEM along the travel, and what it costs."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure import fem
from tensegym.flexure.fem.push import push
from tensegym.flexure.fem.travel import Travel, Y, along, pushed
from tensegym.flexure.hinge import Hinge

from .guide_models import BeamConstraint, GuideModel, PseudoRigid, guide_of
from .joint import Model
from .joint_fit import fit_joint
from .load_solver import solve_model
from .sweep_times import POINTS, best_of

REFERENCE = 64  # elements of the FEM that all are judged by
MESHES = (4, 8, 16)
CLOSED: dict[str, type[BeamConstraint] | type[PseudoRigid]] = {
    "beam constraint model": BeamConstraint,
    "pseudo-rigid body": PseudoRigid,
}
FITTED = {"potential": "potential, fitted", "planar": "planar spring, fitted"}
LARGEST_P = 40.0  # of one leaf, P L^2 / (2 EI), to which the axial range is looked for
STEPS = 33  # of it, either side


@dataclass(frozen=True)
class Column:
    """One model under the same forces."""

    name: str
    poses: FloatArray
    """(n, 3) x, y [m] and turn [rad]; NaN where the model has no answer."""
    across: FloatArray | None
    """(n,) stiffness across [N/m]."""
    along: FloatArray | None
    """(n,) stiffness along, the travel held [N/m]."""
    seconds: float
    """For all n poses, warm, the best of several runs."""

    def errors(self, reference: Travel) -> dict[str, float]:
        """Largest misses of the reference, as shares: of y's and x's largest travel, of the largest turn, of k."""
        states = reference.states
        exact = np.column_stack([states.tip, states.theta])
        size = np.abs(exact - exact[0]).max(axis=0)
        out = dict(zip(("x", "y", "turn"), np.abs(self.poses - exact).max(axis=0) / size, strict=True))
        for name, own, its in (("k y", self.across, reference.drive_stiffness),
                               ("k x", self.along, reference.support_stiffness(0))):  # fmt: skip
            out[name] = float("nan") if own is None else float(np.abs(own / its - 1).max())
        return {name: float(error) for name, error in out.items()}


def compare_guide(hinge: Hinge, reach: float, axial: float = 0.0) -> tuple[Travel, list[Column], str]:
    """The reference, POINTS + 1 even forces from rest to where the travel is ``reach`` [m], and every model under them;
    why there are no fitted ones, empty where there are.

    Raises:
        FlexureError: for a hinge that is no parallelogram, or that cannot be pushed that far.
    """
    guide = guide_of(hinge)
    last = float(push(hinge, [reach], axial=axial, elements=REFERENCE).force[0, 1])
    loads = np.zeros((POINTS + 1, 3))
    loads[:, 0], loads[:, 1] = axial, last * np.arange(POINTS + 1) / POINTS
    reference = _solved(hinge, loads, REFERENCE)
    columns = []
    for elements in MESHES:
        path = _solved(hinge, loads, elements)
        poses = np.column_stack([path.states.tip, path.states.theta])

        def sweep(elements: int = elements) -> object:
            return fem.apply_wrench(hinge, loads, elements=elements, from_rest=False)

        columns.append(Column(f"FEM, {elements} elements", poses, path.drive_stiffness, path.support_stiffness(0),
                              best_of(sweep, 5)))  # fmt: skip
    for name, make in CLOSED.items():
        columns.append(_closed(name, make(guide), loads[:, 1], reference, axial))
    try:
        return reference, columns + _fitted(hinge, loads), ""
    except FlexureError as error:
        return reference, columns, f"no fitted models: {error}"


def axial_range(
    hinge: Hinge, model: GuideModel, reach: float, accepted: float = 0.05
) -> dict[str, tuple[float, float]]:
    """Axial forces [N] between which a model misses y, k across and k along by ``accepted`` at most, at one travel.

    Up to LARGEST_P a leaf in tension, and to buckling in compression.
    """
    guide = guide_of(hinge)
    unit, place = 2 * guide.bending / guide.length**2, np.array([reach])
    inside = dict.fromkeys(("y", "k y", "k x"), (0.0, 0.0))
    for sign in (-1, 1):
        going = set(inside)
        for p in sign * LARGEST_P * np.arange(STEPS) / (STEPS - 1):
            try:
                path = pushed(hinge, place, axial=p * unit)
            except FlexureError:  # buckled
                break
            misses = {
                "y": model.poses(path.states.force[:, 1], p * unit)[0, 1] / reach,
                "k y": model.across(place, p * unit)[0] / path.drive_stiffness[0],
                "k x": model.along(place)[0] / path.support_stiffness(0)[0],
            }
            going -= {name for name, ratio in misses.items() if not abs(ratio - 1) <= accepted}
            for name in going:
                inside[name] = (p * unit, inside[name][1]) if sign < 0 else (inside[name][0], p * unit)
    return inside


def _solved(hinge: Hinge, loads: FloatArray, elements: int) -> Travel:
    solution = fem.apply_wrench(hinge, loads, elements=elements, from_rest=False, keep_nodes=True)
    return along(hinge, solution, Y, elements=elements)


def _closed(name: str, model: GuideModel, force: FloatArray, reference: Travel, axial: float) -> Column:
    travel, seconds = reference.states.tip[:, 1], best_of(lambda: model.poses(force, axial), 20)
    return Column(name, model.poses(force, axial), model.across(travel, axial), model.along(travel), seconds)


def _fitted(hinge: Hinge, loads: FloatArray) -> list[Column]:
    """The fitted models, each by a root of its moment; NaN under loads beyond their box."""
    joint, out = fit_joint(hinge, held_out=0), []
    for key, name in FITTED.items():
        model = joint.models[key]

        def call(model: Model = model) -> FloatArray:
            return np.array([[a.x, a.y, a.theta] for a in solve_model(model, joint.box, loads)])

        poses = call()
        began = time.perf_counter()
        call()  # warm
        out.append(Column(name, poses, None, None, time.perf_counter() - began))
    return out
