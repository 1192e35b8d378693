"""Joint models of a hinge, fitted to its states: the paper's springs, and a passive potential.

    potential.py           Potential: wrench, Jacobian, pose under a load; potential_kernel.py: the same, compiled
    potential_fit.py       fit_potential; potential_terms.py: which coefficients, potential_start.py: the linear start,
                           potential_residual.py: the equations and their Jacobian
    certificate.py         proof of a potential on its box; passivity.py: work around closed loops
    pseudo_rigid.py        where the paper puts its springs: lambda (F1), a and b (F2)
    torsion_spring.py      1-DoF model; planar_spring.py: constant k; stiffness_diagram.py: the guarded inversion
    joint.py               Joint: all models of one hinge, with errors (model_error.py)
    joint_fit.py           fit_joint; joint_file.py: joints in and out of JSON
    load_solver.py         where a model stands under a wrench; model_choice.py: which model is enough
    rod_pin.py             RodPin: the pin that stands for a hinge inside a rod
    guide_models.py        a parallelogram's closed forms (beam constraint model, pseudo-rigid body), and
                           guide_comparison.py: all models of one; notch_formulas.py: compliance of notches
    sweep_times.py         seconds of a sweep by the FEM and by the potential

Every fitting function takes a ``States`` and the rest length L [m] as its first two arguments.
"""

from .joint import MODELS, Joint
from .joint_file import load_joint, save_joint
from .joint_fit import fit_joint
from .model_choice import choose_model
from .planar_spring import PlanarSpring
from .potential import Potential
from .stiffness_diagram import StiffnessDiagram
from .torsion_spring import TorsionSpring

__all__ = [
    "MODELS", "Joint", "PlanarSpring", "Potential", "StiffnessDiagram", "TorsionSpring", "choose_model", "fit_joint",
    "load_joint", "save_joint",
]  # fmt: skip
