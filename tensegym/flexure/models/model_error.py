"""ModelError: how far a joint model is from states it has not seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.flexure.hinge import States


class JointModel(Protocol):
    """Anything that says where the tip is and what moment holds it, given theta and a dead force."""

    def poses(self, theta: FloatArray, force: FloatArray) -> States: ...


@dataclass(frozen=True)
class ModelError:
    """Errors over n states, at the states' own theta and force."""

    tip_rms: float
    """[m]."""
    tip_max: float
    """[m]."""
    moment_rms: float
    """Of the reference moment, as a fraction."""
    moment_max: float
    """Of the reference moment, as a fraction."""
    reference_moment: float
    """[N m]."""
    count: int
    """States compared."""
    lost: int
    """States where the model has no finite answer, left out of the rest."""


def tip_errors(model: JointModel, states: States) -> tuple[FloatArray, FloatArray]:
    """(n,) distance of the tips [m] and (n,) moment errors [N m]."""
    predicted = model.poses(states.theta, states.force)
    return np.linalg.norm(predicted.tip - states.tip, axis=1), predicted.moment - states.moment


def model_errors(model: JointModel, states: States, reference_moment: float) -> ModelError:
    """Errors of one model on states it has not seen.

    Args:
        model: what is judged.
        states: moments all known; errors of the tip are infinite where no tip was measured.
        reference_moment: unit in which moments count [N m].
    """
    tip, moment = tip_errors(model, states)
    good = np.isfinite(moment) & (np.isfinite(tip) | ~np.isfinite(states.tip).all(1))
    tip, moment = tip[good & np.isfinite(tip)], moment[good] / reference_moment
    lost = int((~good).sum())
    if not good.any():
        return ModelError(np.inf, np.inf, np.inf, np.inf, reference_moment, 0, lost)
    of_tip = (float(np.sqrt(np.mean(tip**2))), float(tip.max())) if len(tip) else (np.inf, np.inf)
    return ModelError(*of_tip, float(np.sqrt(np.mean(moment**2))), float(np.abs(moment).max()), reference_moment,
                      int(good.sum()), lost)  # fmt: skip
