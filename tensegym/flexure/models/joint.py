"""Joint: one hinge's fitted models together, with where they hold and how well."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tensegym.errors import FlexureError
from tensegym.flexure.fem import solve as fem
from tensegym.flexure.fem.sampling import Box, default_box, fit_states, held_out_states, moment_at
from tensegym.flexure.hinge.hinge import Hinge
from tensegym.flexure.hinge.states import FloatArray, States, join

from .certificate import Certificate, certify
from .errors_table import ModelError, model_errors
from .planar_spring import PlanarSpring, fit_planar
from .potential import Potential
from .potential_fit import fit_potential
from .pseudo_rigid import Placement, planar_placement
from .stiffness_diagram import StiffnessDiagram, fit_diagram
from .torsion_spring import TorsionSpring, fit_torsion

Model = Potential | PlanarSpring | StiffnessDiagram | TorsionSpring
MODELS = ("potential", "planar", "paper", "torsion")
TABLE_ANGLE = np.radians(24.0)  # of the sweep that gives the paper's Table 1
HELD_OUT_SEED = 12345


@dataclass(frozen=True)
class Joint:
    """Fitted models of one hinge; any may be missing."""

    source: str
    """What was fitted: a hinge's description, or a data file."""
    length: float
    """L [m]."""
    box: Box
    models: dict[str, Model]
    """Of MODELS: potential, planar (constant k), paper (stiffness diagrams), torsion (1-DoF)."""
    errors: dict[str, ModelError] = field(default_factory=dict)
    """Held out, or residuals where nothing could be held out; ``errors_of`` says which."""
    errors_of: str = ""
    hinge: Hinge | None = None
    notes: tuple[str, ...] = ()
    """What a user must know: unidentified coefficients, singular angles."""

    def model(self, name: str) -> Model:
        """One model by name. Raises FlexureError when the joint has none of that name."""
        if name not in self.models:
            raise FlexureError(f"this joint has no model {name!r}; it has {', '.join(self.models)}")
        return self.models[name]

    def certificate(self) -> Certificate:
        """Proof of the potential on its box; raises FlexureError when there is none."""
        potential = self.model("potential")
        assert isinstance(potential, Potential)
        return certify(potential)


def arm_sweep(hinge: Hinge, max_angle: float, count: int = 60, elements: int = fem.ELEMENTS) -> States:
    """2 count + 1 states over +-max_angle, a force in base y at the end of the arm: the paper's stand and sweep.

    A hinge without an arm is turned by a pure moment.
    """
    angle = max_angle * np.arange(1, count + 1) / count
    parts = [_half_sweep(hinge, -angle, elements).pick(slice(None, None, -1)),
             States(np.zeros(1), np.array([[hinge.length, 0.0]]), np.zeros((1, 2)), np.zeros(1)),
             _half_sweep(hinge, angle, elements)]  # fmt: skip
    return join(parts)


def _half_sweep(hinge: Hinge, angle: FloatArray, elements: int) -> States:
    direction = fem.arm_direction(angle, hinge.arm) if hinge.arm else (0.0, 0.0, 1.0)
    solution = fem.rotate(hinge, angle, direction=direction, elements=elements)
    bad = np.flatnonzero(solution.status != fem.CONVERGED)
    if len(bad):
        raise FlexureError(f"{hinge.name}: the arm's sweep {solution.reason(int(bad[0]))} towards "
                           f"{np.degrees(angle[bad[0]]):.3g} deg; lower max_angle")  # fmt: skip
    return solution.states()


def placement_of(hinge: Hinge, reading: str = "dx", max_angle: float = TABLE_ANGLE) -> Placement:
    """a, b and drift of the planar spring from the arm's sweep."""
    return planar_placement(arm_sweep(hinge, min(max_angle, hinge.max_angle)), hinge.length, reading)


def symmetry_of(hinge: Hinge) -> str:
    """both, axis or none: which mirror images leave the hinge as it is (within 1 nm; widths in one place add up)."""

    def shapes(flip_x: bool, flip_y: bool) -> dict[tuple[int, ...], int]:
        out: dict[tuple[int, ...], int] = {}
        for leaf in hinge.leaves:
            ends = sorted((round(1e9 * (hinge.length - x if flip_x else x)), round(1e9 * (-y if flip_y else y)))
                          for x, y in (leaf.start, leaf.end))  # fmt: skip
            place = (*ends[0], *ends[1], round(1e9 * leaf.thickness))
            out[place] = out.get(place, 0) + round(1e9 * leaf.width)
        return out

    if shapes(False, True) != shapes(False, False):
        return "none"
    return "both" if shapes(True, False) == shapes(False, False) else "axis"


def fit_joint(hinge: Hinge, *, max_angle: float | None = None, max_force: float | None = None, count: int = 600,
              held_out: int = 300, seed: int = 0, elements: int = fem.ELEMENTS) -> Joint:  # fmt: skip
    """Fit every model to the hinge's FEM states, certify the potential, and measure all on states held out.

    Raises FlexureError when the box goes past buckling or the certificate fails.
    """
    if seed == HELD_OUT_SEED:
        raise FlexureError(f"seed = {seed} draws the states held out; take another")
    box = default_box(hinge, max_angle, max_force)
    states = fit_states(hinge, box, count, seed, elements)
    fit = fit_potential(states, hinge.length, box=box, symmetry=symmetry_of(hinge))
    certify(fit.potential)
    sweep = arm_sweep(hinge, box.max_angle, elements=elements)
    models: dict[str, Model] = {"potential": fit.potential, "planar": fit_planar(states, hinge.length)}
    notes = []
    if fit.unidentified:
        notes.append(f"the states cannot tell {', '.join(fit.unidentified)}")
    try:
        models["paper"] = fit_diagram(sweep, hinge.length)
    except FlexureError as error:
        notes.append(f"no stiffness diagrams: {error}")
    try:
        models["torsion"] = fit_torsion(sweep, hinge.length)
    except FlexureError as error:
        notes.append(f"no torsion spring: {error}")
    errors = {}
    if held_out:
        test = held_out_states(hinge, box, held_out, HELD_OUT_SEED, elements)
        reference = moment_at(hinge, box.max_angle, elements)
        errors = {name: model_errors(model, test, reference) for name, model in models.items()}
    return Joint(hinge.describe(), hinge.length, box, models, errors, f"{held_out} random wrenches held out", hinge,
                 tuple(notes))  # fmt: skip
