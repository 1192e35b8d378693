"""Hinges: what they are made of, and the states of equilibrium that someone saw them in.

    hinge.py        Material, Leaf, Hinge: leaves and rigid bodies as a planar graph
    profile.py      Taper, Notch: how a leaf's thickness runs along it
    presets.py      the paper's four hinges and more topologies, by name
    hinge_file.py   hinges in and out of TOML
    symmetry.py     which mirror images leave a hinge as it is
    states.py       States: (theta, tip, force, moment), from a FEM or a measurement
    box.py          Box: the rotations and forces a model is fitted to
    ranges.py       the ranges of numbers they keep to

SI units; millimetres only in files, and said so in the field's name.
"""

from .box import Box
from .hinge import GROUND, TIP, Hinge, Leaf, Material
from .hinge_file import as_hinge, hinge_from_dict, hinge_to_dict, hinge_to_toml
from .presets import PAPER_HINGES, PRESETS, preset
from .profile import Notch, Taper
from .states import States, join
from .symmetry import symmetry_of

__all__ = [
    "GROUND", "PAPER_HINGES", "PRESETS", "TIP", "Box", "Hinge", "Leaf", "Material", "Notch", "States", "Taper",
    "as_hinge", "hinge_from_dict", "hinge_to_dict", "hinge_to_toml", "join", "preset", "symmetry_of",
]  # fmt: skip
