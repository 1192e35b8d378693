"""Which joint model is enough: the criterion of the paper's discussion as a function.

The paper reads it off the drift of the axis: little drift along Ox and Oy, take the torsion spring; drift, take the
planar one. Here the drift is the distance of the tip from where the simpler model puts it; models are tried in order.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tensegym.errors import FlexureError
from tensegym.flexure.fem.arm_sweep import arm_sweep
from tensegym.flexure.fem.sampling import HELD_OUT_SEED, held_out_states
from tensegym.flexure.hinge import Hinge
from tensegym.flexure.hinge.ranges import check_positive

from .joint import Joint
from .joint_fit import fit_joint
from .model_error import tip_errors
from .pseudo_rigid import Placement, planar_placement

ORDER = ("torsion", "planar", "potential")


@dataclass(frozen=True)
class Choice:
    """The simplest model whose tip stays within the accepted error, and why."""

    model: str
    """torsion (1-DoF), planar, potential, or fem when none is enough."""
    tip_errors: dict[str, float]
    """Largest distance of the tip from the FEM's over the arm's sweep and the held-out loads [m], each model tried."""
    drift: Placement
    """Drift of the axis on the arm's sweep: dx and dy of the planar spring of the paper's Table 1."""
    reason: str


def choose_model(hinge: Hinge, accepted: float, *, loads: str = "arm", joint: Joint | None = None) -> Choice:
    """The simplest of the torsion spring, the planar spring and the potential whose tip errors are accepted.

    Args:
        hinge: what is to be modelled.
        accepted: largest error of the tip [m], above 0.
        loads: "arm" judges on the paper's sweep (a force across the arm, one load path); "box" also on random loads of
            the joint's box.
        joint: fitted to the hinge; without it the hinge is fitted now.

    Raises:
        FlexureError: for an accepted error that is not positive, or other loads.
    """
    check_positive("accepted", accepted, "m")
    if loads not in ("arm", "box"):
        raise FlexureError(f"loads = {loads!r}; arm or box")
    joint = joint or fit_joint(hinge, held_out=0)
    sweep = arm_sweep(hinge, joint.box.max_angle)
    inside = sweep.pick(joint.box.holds(sweep.force))
    errors: dict[str, float] = {}
    chosen = "fem"
    for name in ORDER:
        if name not in joint.models:
            continue
        worst = float(np.max(tip_errors(joint.models[name], inside)[0]))
        if loads == "box":
            test = held_out_states(hinge, joint.box, seed=HELD_OUT_SEED)
            worst = max(worst, float(np.max(tip_errors(joint.models[name], test)[0])))
        errors[name] = worst
        if worst <= accepted:
            chosen = name
            break
    drift = planar_placement(sweep, hinge.length)
    tried = ", ".join(f"{name} {1e3 * error:.3g} mm" for name, error in errors.items())
    over = {"arm": "the arm's sweep", "box": "the arm's sweep and random loads of the box"}[loads]
    reason = f"accepted {1e3 * accepted:.3g} mm; drift of the tip from the model over {over}: {tried}"
    return Choice(chosen, errors, drift, reason)
