"""Flexible joints, timed side by side in one process on one thread: exudyn, our FEM, the potential.

    python benchmarks/flexure.py

The sweep: 60 states from rest to the pure moment that turns the tip by 30 deg. exudyn gets one static solve with 60
load steps, the fastest of its solver settings tried; ours is 60 rotation-controlled states. Both are given the smallest
number of elements whose tip at 30 deg is within 1e-5 mm of a fine mesh. Building the models is not counted. Times of
exudyn and of fits are the thread's own (CPU), so that a busy machine does not blur them.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from tensegym.flexure import fem
from tensegym.flexure.fem import newton
from tensegym.flexure.fem.path import sweep
from tensegym.flexure.hinge import PAPER_HINGES, Hinge, preset
from tensegym.flexure.models import potential_kernel as kernel
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.flexure.models.potential import Potential
from tensegym.flexure.models.sweep_times import POINTS, best_of, sweep_times
from tensegym.report import table

ANGLE = np.radians(30.0)
ACCURACY = 1e-8  # m, of the tip at 30 deg
MESHES = (4, 6, 8, 12, 16, 24)


@dataclass(frozen=True)
class Run:
    """One sweep's end and time."""

    tip: np.ndarray
    theta: float
    seconds: float


def exudyn_sweep(hinge: Hinge, moment: float, elements: int, *, force: tuple[float, float] = (0.0, 0.0),
                 sparse: bool = False, modified: bool = False, steps: int = POINTS) -> Run:  # fmt: skip
    """The hinge in exudyn: ANCF cables clamped to a rigid tip that takes ``moment`` [N m] and ``force`` [N] in even
    load steps."""
    import exudyn as exu
    from exudyn.utilities import (
        Cable2D,
        Force,
        GenericJoint,
        MarkerBodyRigid,
        ObjectGround,
        Point2DS1,
        Rigid2D,
        RigidBody2D,
        RotationMatrixZ,
        Torque,
    )

    system = exu.SystemContainer().AddSystem()
    ground = system.AddObject(ObjectGround())
    node = system.AddNode(Rigid2D(referenceCoordinates=[hinge.length, 0, 0]))
    tip = system.AddObject(RigidBody2D(mass=1e-3, inertia=1e-6, nodeNumber=node))  # statics: never used
    modulus = hinge.material.effective_modulus
    for leaf in hinge.leaves:
        start, end = np.array(leaf.start), np.array(leaf.end)
        along = (end - start) / leaf.length
        count = max(4, round(elements * leaf.length / hinge.length))
        step = leaf.length / count
        area = leaf.width * leaf.thickness
        nodes = [system.AddNode(Point2DS1(referenceCoordinates=[*(start + along * step * i), *along]))
                 for i in range(count + 1)]  # fmt: skip
        cables = [system.AddObject(Cable2D(length=step, massPerLength=1e-2, axialStiffness=modulus * area,
                                           bendingStiffness=modulus * area * leaf.thickness**2 / 12,
                                           nodeNumbers=nodes[i : i + 2])) for i in range(count)]  # fmt: skip
        turned = RotationMatrixZ(np.arctan2(along[1], along[0]))
        clamps = ((ground, start, cables[0], 0.0), (tip, end - [hinge.length, 0], cables[-1], step))
        for body, place, cable, at in clamps:
            frame = exu.HT(rotation=turned, translation=[*place, 0])
            on_body = system.AddMarker(MarkerBodyRigid(bodyNumber=body, localHT=frame))
            on_cable = system.AddMarker(MarkerBodyRigid(bodyNumber=cable, localPosition=[at, 0, 0]))
            system.AddObject(GenericJoint(markerNumbers=[on_body, on_cable], constrainedAxes=[1, 1, 0, 0, 0, 1]))
    loaded = system.AddMarker(MarkerBodyRigid(bodyNumber=tip))
    system.AddLoad(Torque(markerNumber=loaded, loadVector=[0, 0, moment]))
    system.AddLoad(Force(markerNumber=loaded, loadVector=[*force, 0]))
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse if sparse else exu.LinearSolverType.EXUdense
    settings.staticSolver.numberOfLoadSteps = steps
    settings.staticSolver.newton.useModifiedNewton = modified
    settings.staticSolver.newton.relativeTolerance = 1e-8
    settings.staticSolver.newton.absoluteTolerance = 1e-10
    settings.staticSolver.verboseMode = 0
    began = time.process_time()
    if not system.SolveStatic(settings):
        raise RuntimeError(f"exudyn found no equilibrium of {hinge.name}")
    seconds = time.process_time() - began
    moved = system.GetNodeOutput(node, exu.OutputVariableType.Coordinates)
    return Run(np.array([hinge.length + moved[0], moved[1]]), float(moved[2]), seconds)


def fastest_exudyn(hinge: Hinge, moment: float, elements: int) -> Run:
    """The best of its settings, four times each."""
    runs = [exudyn_sweep(hinge, moment, elements, sparse=sparse, modified=modified)
            for sparse in (False, True) for modified in (False, True) for _ in range(4)]  # fmt: skip
    return min(runs, key=lambda run: run.seconds)


def our_sweep(hinge: Hinge, elements: int) -> Run:
    """Ours, warm."""
    mesh = fem.mesh_of(hinge, elements)
    cases = np.zeros((POINTS, 8))
    cases[:, newton.THETA] = ANGLE * np.arange(1, POINTS + 1) / POINTS
    cases[:, newton.WM] = 1.0
    results = sweep(mesh, newton.ROTATION, cases, False, False)[0]
    seconds = best_of(lambda: sweep(mesh, newton.ROTATION, cases, False, False), 20)
    return Run(results[-1, 1:3], float(results[-1, 0]), seconds)


def exudyn_rows() -> list[list[str]]:
    """Hinge by hinge: elements, tip error and time of both."""
    rows = []
    for name in ("leaf-spring", "tfch"):
        hinge = preset(name)
        fine = fem.rotate(hinge, np.array([ANGLE]), elements=128)
        moment = float(fine.moment[0])
        theirs = coarsest(lambda n, h=hinge, m=moment: fastest_exudyn(h, m, n), fine)
        ours = coarsest(lambda n, h=hinge: our_sweep(h, n), fine)
        row = [name]
        for n, run in (theirs, ours):
            row += [str(n), f"{1e3 * _error(run, fine):.1e}", f"{1e3 * run.seconds:.2f}"]
        rows.append([*row, f"{theirs[1].seconds / ours[1].seconds:.0f}"])
    return rows


def coarsest(sweep: Callable[[int], Run], fine: fem.Solution) -> tuple[int, Run]:
    """The smallest number of elements that reaches ACCURACY, and its run."""
    for count in MESHES:
        run = sweep(count)
        if _error(run, fine) < ACCURACY:
            return count, run
    raise RuntimeError(f"no mesh up to {MESHES[-1]} elements is within {ACCURACY:g} m")


def _error(run: Run, fine: fem.Solution) -> float:
    return float(np.linalg.norm(run.tip - fine.tip[-1]))


def main() -> None:
    try:
        rows = exudyn_rows()
        header = ["hinge", "exudyn elements", "error mm", "ms", "ours elements", "error mm", "ms", "ratio"]
        print("60-point sweep to 30 deg for the same accuracy, exudyn against our FEM")
        print(table(header, rows))
    except ImportError:
        print("exudyn is not installed (pip install exudyn): its comparison is left out")
    rows = []
    for name in PAPER_HINGES:
        hinge = preset(name)
        fit_joint(hinge, held_out=0)
        began = time.process_time()
        joint = fit_joint(hinge, held_out=0)
        fit_seconds = time.process_time() - began
        potential = joint.models["potential"]
        assert isinstance(potential, Potential)
        times = sweep_times(joint)
        poses = np.random.default_rng(0).uniform(-1, 1, (20000, 3)) * [1e-4, 1e-3, 0.5] + [hinge.length, 0, 0]
        model = (potential.coefficients, potential.scales, poses)
        one = best_of(partial(kernel.wrench_batch, *model), 10) / len(poses)
        both = best_of(partial(kernel.stiffness_batch, *model), 10) / len(poses)
        row = [f"{1e3 * times.fem:.3f}", f"{1e6 * times.potential:.2f}", f"{times.fem / times.potential:.0f}"]
        rows.append([name, *row, f"{fit_seconds:.2f}", f"{1e9 * one:.0f}", f"{1e9 * both:.0f}"])
    print("\n60-point sweep, force across the arm: our FEM (16 elements) against the potential; a fit; a wrench")
    header = ["hinge", "FEM ms", "potential us", "ratio", "fit s", "ns a wrench", "ns with Jacobian"]
    print(table(header, rows))


if __name__ == "__main__":
    main()
