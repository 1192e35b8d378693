"""Joint: one hinge's fitted models together, with where they hold and how well."""

from __future__ import annotations

from dataclasses import dataclass, field

from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Box, Hinge

from .certificate import Certificate, certify
from .model_error import ModelError
from .planar_spring import PlanarSpring
from .potential import Potential
from .stiffness_diagram import StiffnessDiagram
from .torsion_spring import TorsionSpring

Model = Potential | PlanarSpring | StiffnessDiagram | TorsionSpring
MODELS = {
    "potential": "potential",
    "planar": "planar spring, constant k",
    "paper": "paper's stiffness diagrams",
    "torsion": "torsion spring, 1-DoF",
}
"""Names of the models, and what tables and figures call them."""


@dataclass(frozen=True)
class Joint:
    """Fitted models of one hinge; any may be missing."""

    source: str
    """What was fitted: a hinge's description, or a data file."""
    length: float
    """L [m]."""
    box: Box
    models: dict[str, Model]
    """By their names in MODELS."""
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
