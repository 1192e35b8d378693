"""Hinge: leaves and rigid bodies as a small planar graph."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.tables import show

from .profile import Profile
from .ranges import (
    check_choice,
    check_max_angle,
    check_not_negative,
    check_positive,
    finite_array,
    is_number,
    shown,
)

GROUND, TIP = "ground", "tip"
Point = tuple[float, float]


@dataclass(frozen=True)
class Material:
    """Linear elastic, and which modulus a bent leaf shows."""

    youngs_modulus: float = 2.95e9
    """E [Pa], in (0, inf). Default: the PETG of the paper."""
    poisson_ratio: float = 0.38
    """nu, in (-1, 0.5)."""
    modulus: str = "beam"
    """beam: E (narrow leaf); plate: E / (1 - nu^2) (wide leaf); factor: ``factor`` times E."""
    factor: float = 1.0
    """The user's factor on E, in (0, inf); used with modulus = factor only."""

    def __post_init__(self) -> None:
        check_positive("youngs_modulus", self.youngs_modulus, "Pa")
        if not (is_number(self.poisson_ratio) and -1 < self.poisson_ratio < 0.5):
            raise FlexureError(f"poisson_ratio = {shown(self.poisson_ratio)} is outside (-1, 0.5); PETG has 0.38")
        check_choice("modulus", self.modulus, ("beam", "plate", "factor"))
        check_positive("factor", self.factor)
        if self.modulus != "factor" and self.factor != 1.0:
            raise FlexureError(
                f"factor = {self.factor:g} has no effect with modulus = {self.modulus}; use modulus = factor"
            )

    @property
    def effective_modulus(self) -> float:
        """Modulus of bending and stretching a leaf [Pa]."""
        scale = {"beam": 1.0, "plate": 1 / (1 - self.poisson_ratio**2), "factor": self.factor}[self.modulus]
        return scale * self.youngs_modulus

    @property
    def modulus_name(self) -> str:
        """Which modulus, for every output."""
        return {"beam": "beam modulus E", "plate": "plate modulus E/(1-nu^2)",
                "factor": f"user's modulus {self.factor:g} E"}[self.modulus]  # fmt: skip


@dataclass(frozen=True)
class Leaf:
    """A straight leaf, clamped at both ends to a rigid body; points in base axes at rest [m]."""

    start_body: str
    start: Point
    end_body: str
    end: Point
    width: float
    """Out of plane [m]."""
    thickness: float
    """In plane [m]; of a taper at its start, of a notch at its web."""
    profile: Profile | None = None
    """How the thickness runs along the leaf; None: it is constant."""

    def __post_init__(self) -> None:
        for what, point in (("start", self.start), ("end", self.end)):
            finite_array(point, f"leaf {self.start_body}-{self.end_body}: {what}", 2)
        if self.start_body == self.end_body:
            raise FlexureError(f"a leaf joins {self.start_body!r} to itself; its ends need two bodies")
        check_positive(f"leaf {self.start_body}-{self.end_body}: width", self.width, "m")
        check_positive(f"leaf {self.start_body}-{self.end_body}: thickness", self.thickness, "m")
        if not self.thickness < self.length / 4:
            raise FlexureError(
                f"leaf {self.start_body}-{self.end_body}: thickness = {self.thickness:g} m at a length of "
                f"{self.length:g} m; beam theory needs a thickness below length / 4"
            )
        if self.profile is not None:
            self.profile.check(f"leaf {self.start_body}-{self.end_body}", self.thickness, self.length)

    @property
    def length(self) -> float:
        return math.dist(self.start, self.end)

    @property
    def thinnest(self) -> float:
        """Smallest thickness [m]."""
        return min(self.thickness, *self.end_thicknesses)

    @property
    def end_thicknesses(self) -> tuple[float, float]:
        """Thickness at the start and at the end [m]."""
        return (self.thickness, self.thickness) if self.profile is None else self.profile.ends(self.thickness)

    def thickness_at(self, share: FloatArray) -> FloatArray:
        """Thickness (n,) [m] at shares (n,) of the length, 0 at the start and 1 at the end."""
        if self.profile is None:
            return np.full(np.shape(share), self.thickness)
        return self.profile.at(share, self.thickness, self.length)


@dataclass(frozen=True)
class Hinge:
    """Bodies "ground" (fixed), "tip" (moving) and others between, joined by leaves.

    Raises FlexureError when a body hangs on nothing, a name is unknown, or a size is out of range.
    """

    name: str
    leaves: tuple[Leaf, ...]
    length: float
    """L [m]: the tip point B is at (L, 0) at rest."""
    bodies: tuple[str, ...] = (GROUND, TIP)
    material: Material = field(default_factory=Material)
    arm: float = 0.12
    """Lever of the test stand, along x beyond the tip [m], in [0, inf)."""
    max_angle: float = math.radians(30)
    """Largest rotation the hinge is meant for [rad], in (0, pi/2): the range of fits and tables."""

    def __post_init__(self) -> None:
        check_positive("length", self.length, "m")
        check_not_negative("arm", self.arm, "m")
        check_max_angle(self.max_angle)
        if not all(isinstance(body, str) for body in (self.name, *self.bodies)):
            raise FlexureError(f"name and bodies must be texts: {show(self.name)}, {show(self.bodies)}")
        if len(set(self.bodies)) != len(self.bodies) or not {GROUND, TIP} <= set(self.bodies):
            raise FlexureError(f"bodies = {list(self.bodies)}; give each once, with {GROUND!r} and {TIP!r} among them")
        for leaf in self.leaves:
            for body in (leaf.start_body, leaf.end_body):
                if body not in self.bodies:
                    raise FlexureError(f"a leaf names body {body!r}; the bodies are {', '.join(self.bodies)}")
        held = {GROUND}
        for _ in self.bodies:
            for leaf in self.leaves:
                if held & {leaf.start_body, leaf.end_body}:
                    held |= {leaf.start_body, leaf.end_body}
        loose = [body for body in self.bodies if body not in held]
        if loose:
            raise FlexureError(f"body {loose[0]!r} is disconnected: no chain of leaves joins it to {GROUND!r}; add one")

    def with_material(self, material: Material) -> Hinge:
        """The same shape of another material."""
        return replace(self, material=material)

    def describe(self) -> str:
        """One line for the head of an output."""
        count = "1 leaf" if len(self.leaves) == 1 else f"{len(self.leaves)} leaves"
        return (f"{self.name}: L = {self.length * 1e3:g} mm, {count}, E = "
                f"{self.material.youngs_modulus / 1e9:g} GPa, {self.material.modulus_name}")  # fmt: skip
