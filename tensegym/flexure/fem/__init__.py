"""Reference FEM of a hinge: equilibrium states under rotation, load or wrench control.

Corotational beams, fourth-order convergent, with analytic tangent; exact to the elastica within 3e-7 L at 16 elements a
length L. Planar; leaves bend by Euler and Bernoulli (no shear), bodies are rigid, loads are dead. Call it by its name:
``from tensegym.flexure import fem``, then ``fem.rotate(hinge, theta)``.

    equilibrium.py   rotate (rotation control), apply_wrench (load and wrench control), arm_direction
    solution.py      Solution: the states, or why one is missing
    mesh.py          Mesh: a hinge as flat arrays; mesh_error.py: how far it is off, and which mesh would do
    beam.py          the element's energy, gradient and Hessian; chain.py: one leaf condensed to its ends
    assembly.py      all leaves and bodies together; memory.py: state and workspace; ldl.py: the factorisation
    newton.py        one load case; path.py: from case to case, no instability stepped over
    arm_sweep.py     the paper's stand: a force across the arm, through the range
    push.py          travel control; travel.py: stiffness, stress and buckling along a path
    tangent.py       stiffness at the tip and load factor of a state; stress.py, out_of_plane.py: more of it
    sampling.py      states of a hinge over its box, for fits and held out from them
    buckling.py      buckling load of a rod with a hinge in it; centre_shift.py: of a pivot

From beam.py to path.py all is compiled by numba.
"""

from .equilibrium import apply_wrench, arm_direction, rotate
from .mesh import ELEMENTS, mesh_of
from .path import BUCKLED, CONVERGED, FAILED
from .solution import Solution

__all__ = [
    "BUCKLED", "CONVERGED", "ELEMENTS", "FAILED", "Solution", "apply_wrench", "arm_direction", "mesh_of", "rotate",
]  # fmt: skip
