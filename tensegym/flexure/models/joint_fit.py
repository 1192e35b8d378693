"""A hinge fitted with every joint model, from its FEM alone."""

from __future__ import annotations

from collections.abc import Callable

from tensegym.errors import FlexureError
from tensegym.flexure.fem import ELEMENTS
from tensegym.flexure.fem.arm_sweep import arm_sweep
from tensegym.flexure.fem.mesh_error import too_coarse
from tensegym.flexure.fem.sampling import HELD_OUT_SEED, default_box, fit_states, held_out_states, moment_at
from tensegym.flexure.hinge import Hinge, States, symmetry_of
from tensegym.flexure.hinge.box import Ends

from .certificate import certify
from .joint import Joint, Model
from .model_error import model_errors
from .planar_spring import fit_planar
from .potential_fit import fit_potential
from .stiffness_diagram import fit_diagram
from .torsion_spring import fit_torsion

_OF_THE_SWEEP: dict[str, tuple[Callable[[States, float], Model], str]] = {
    "paper": (fit_diagram, "stiffness diagrams"),
    "torsion": (fit_torsion, "torsion spring"),
}
"""Models that the paper fits to one load path: by what, and what a note calls them."""


def fit_joint(
    hinge: Hinge, *, max_angle: float | None = None, max_force: float | None = None, force_x: Ends | None = None,
    force_y: Ends | None = None, count: int = 600, held_out: int = 300, seed: int = 0, elements: int = ELEMENTS,
) -> Joint:  # fmt: skip
    """Fit every model to a hinge's FEM states, certify the potential, and measure all on states held out.

    Args:
        hinge: what is fitted.
        max_angle: half range of rotation [rad]; the hinge's own by default.
        max_force: half range of the force at the tip on either base axis [N]; see ``default_box``.
        force_x, force_y: least and largest force on an axis in place of +-max_force [N].
        count: FEM states that are fitted.
        held_out: random wrenches that the models are judged on; 0 for none.
        seed: of the fitted states.
        elements: of a leaf as long as the hinge.

    Returns:
        The joint with its potential and planar spring, and with the paper's diagrams and torsion spring where the
        arm's sweep gives them; its notes say why not.

    Raises:
        FlexureError: when the box goes past buckling, the certificate fails, or the seed is that of the states held
            out.
    """
    if isinstance(seed, int) and seed == HELD_OUT_SEED:
        raise FlexureError(f"seed = {seed} draws the states held out; take another")
    box = default_box(hinge, max_angle, max_force, force_x, force_y)
    states = fit_states(hinge, box, count, seed, elements)
    fit = fit_potential(states, hinge.length, box=box, symmetry=symmetry_of(hinge))
    certify(fit.potential)
    models: dict[str, Model] = {"potential": fit.potential, "planar": fit_planar(states, hinge.length)}
    notes = [f"the states cannot tell {', '.join(fit.unidentified)}"] if fit.unidentified else []
    coarse = too_coarse(hinge, box.max_angle, elements)
    if coarse:
        notes.append(coarse)
    if not hinge.arm:
        notes.append("no arm: stiffness diagrams and torsion spring are fitted to a pure moment's sweep")
    sweep = arm_sweep(hinge, box.max_angle, elements=elements)
    for name, (fit_model, title) in _OF_THE_SWEEP.items():
        try:
            models[name] = fit_model(sweep, hinge.length)
        except FlexureError as error:
            notes.append(f"no {title}: {error}")
    errors = {}
    if held_out:
        test = held_out_states(hinge, box, held_out, HELD_OUT_SEED, elements)
        reference = moment_at(hinge, box.max_angle, elements)
        errors = {name: model_errors(model, test, reference) for name, model in models.items()}
    return Joint(hinge.describe(), hinge.length, box, models, errors, f"{held_out} random wrenches held out", hinge,
                 tuple(notes))  # fmt: skip
