"""RobotDesign: every physical parameter of a robot, validated where it is made. SI units throughout."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from tensegym.arrays import FloatArray, IntArray, frozen
from tensegym.errors import DesignError, FlexureError
from tensegym.structure import structure as structures
from tensegym.structure.equilibrium import compressions, shared_compressions
from tensegym.structure.structure import Structure
from tensegym.tables import bounded, check_fields, noted, one_line, parsed

from .groups import Group, check_groups, column, groups_from, of_members
from .parameters import Drive, ElasticCable, Keep, Payload, Rod, RodFlexure, StiffCable
from .prestress import check_stretch, prestressed
from .shape import Shape, check_shape, shape_of
from .split_rod import half_length, split_buckling_load, standing_pin

if TYPE_CHECKING:
    from tensegym.flexure.models.rod_pin import RodPin


@dataclass(frozen=True)
class RobotDesign:
    """Every physical parameter of a robot. `standing` is the structure it is built in.

    Raises DesignError or StructureError, naming field, value and allowed range.
    """

    structure: Structure = field(default_factory=structures.six_rod,
                                 metadata={"what": "nodes, rods and cables, or the size of six rods"})  # fmt: skip
    name: str = noted("six_rod", "of the robot")
    form_finding: bool = noted(True, "move the nodes so that the pretension balances; else they must balance as given")
    keep: Keep | None = noted(None, "what form finding does not change")
    passive_rod: Rod = noted(Rod(), "rods without drives")
    active_rod: Rod = noted(Rod(tube_mass=0.038, end_mass=0.2, end_mass_radius=0.016), "rods that carry drives")
    elastic_cable: ElasticCable = noted(ElasticCable(), "the cables that hold the robot")
    stiff_cable: StiffCable = noted(StiffCable(), "the cables that drives wind")
    drive: Drive = noted(Drive(), "of every stiff cable")
    payload: Payload | None = noted(None, "a ball in the middle")
    flexure: RodFlexure | None = noted(None, "a hinge that splits rods")
    cables: tuple[Group, ...] = parsed(partial(groups_from, "cables"), (), "groups of elastic cables, by name: their "
                                       "pairs, and what differs from elastic_cable")
    rods: tuple[Group, ...] = parsed(partial(groups_from, "rods"), (), "groups of rods, by name: their pairs, and what "
                                     "differs from passive_rod or active_rod")
    drives: tuple[Group, ...] = parsed(partial(groups_from, "drives"), (), "groups of stiff cables with their drives, "
                                       "by name: their pairs, and what differs from drive and stiff_cable")
    attachment_radius: float = bounded(0, 0.1, 0.004, "m", "cables are tied this far from the rod's axis")
    spin_damping: float = bounded(0, 1, 1e-4, "N m s/rad", "resists a rod's spin about its own axis")
    friction: float = bounded(0, 10, 0.8, "", "Coulomb coefficient, feet and rods against ground and each other")
    gravity: float = bounded(0, 100, 9.81, "m/s^2", "downward")

    def __post_init__(self) -> None:
        check_fields(self, DesignError)
        for kind, pairs in (("cables", self.structure.cables), ("rods", self.structure.rods),
                            ("drives", self.structure.stiff_cables)):  # fmt: skip
            check_groups(kind, getattr(self, kind), pairs)
        found = prestressed(self.built, self.each_cable, self.cables, self.keep, self.form_finding,
                            self.payload.pretension if self.payload else 0.0)  # fmt: skip
        object.__setattr__(self, "_found", found)
        self._check_lengths()
        check_shape(self.shape, self.standing, self.rest_tensions)
        object.__setattr__(self, "_rod_pins", {})
        try:
            self._check_flexures()
        except FlexureError as error:
            raise DesignError(one_line(f"RodFlexure: {error}")) from error

    def _check_lengths(self) -> None:
        """Refuse cables that their pretension stretches from nothing."""
        rest = self.standing.lengths(self.standing.cables) - 2 * self.attachment_radius
        check_stretch(self.each_cable, self.rest_tensions, rest, self.cable_natural_lengths)
        if self.payload is not None and self.payload_natural_length <= 0:
            raise DesignError(
                f"Payload.pretension = {self.payload.pretension!r} leaves its cables no natural length "
                f"({self.payload_natural_length:.4g} m); lower the pretension or the radius, or raise the stiffness"
            )

    def _check_flexures(self) -> None:
        """Refuse rods that the prestress would buckle, and hinges that no pin stands for."""
        if self.flexure is None:
            return
        if len(self.structure.shared):
            raise DesignError(f"RodFlexure: node {self.structure.shared[0] + 1} is on more than one rod; rods that "
                              "share nodes cannot be split, leave [flexure] out")  # fmt: skip
        for rod in self.flexible_rods.tolist():
            a, b = self.structure.rods[rod] + 1
            length, compression = float(self.standing.rod_lengths[rod]), float(self.rod_compressions[rod])
            self.rod_pins[rod] = standing_pin(self.flexure, length, compression, f"{a}-{b}")

    @property
    def standing(self) -> Structure:
        """The structure at rest: form-found, or as given."""
        return self._found.structure  # type: ignore[attr-defined]

    @cached_property
    def shape(self) -> Shape:
        """How far form finding moved the nodes, and whether the prestress holds what it made; payloads and flexures
        left out."""
        stiffness = column(self.each_cable, "stiffness")
        return shape_of(self.built, self.standing, self.rest_tensions, stiffness, self.attachment_radius)

    @cached_property
    def active_rods(self) -> IntArray:
        """Rods that carry drives: (a,) indices, ascending."""
        driven = np.isin(self.structure.rods, self.structure.stiff_cables[:, 0]).any(axis=1)
        return frozen(np.flatnonzero(driven))

    @cached_property
    def each_cable(self) -> tuple[ElasticCable, ...]:
        """(c,) what each elastic cable is, by its group."""
        return of_members(self.cables, self.structure.cables, len(self.structure.cables) * [self.elastic_cable])

    @cached_property
    def each_rod(self) -> tuple[Rod, ...]:
        """(r,) what each rod is."""
        rods = range(len(self.structure.rods))
        common = [self.active_rod if rod in self.active_rods else self.passive_rod for rod in rods]
        return of_members(self.rods, self.structure.rods, common)

    @cached_property
    def each_stiff_cable(self) -> tuple[StiffCable, ...]:
        """(w,) what each stiff cable is."""
        pairs = self.structure.stiff_cables
        return of_members(self.drives, pairs, len(pairs) * [self.stiff_cable])

    @cached_property
    def each_drive(self) -> tuple[Drive, ...]:
        """(w,) what each drive is."""
        return of_members(self.drives, self.structure.stiff_cables, len(self.structure.stiff_cables) * [self.drive])

    @property
    def deepest_pull(self) -> float:
        """That all drives may make, as a part of their cables' rest lengths."""
        return min((cable.max_pull for cable in self.each_stiff_cable), default=self.stiff_cable.max_pull)

    @cached_property
    def built(self) -> Structure:
        """The structure as given, its rods of the lengths that they are given."""
        lengths = [np.nan if rod.length is None else rod.length for rod in self.each_rod]
        return self.structure.with_rod_lengths(lengths)

    @property
    def rest_tensions(self) -> FloatArray:
        """(c,) of the elastic cables at rest [N]; NaN of those that natural lengths hold where nothing balances."""
        return self._found.tensions  # type: ignore[attr-defined]

    def rod(self, index: int) -> Rod:
        """What the rod at this index is."""
        return self.each_rod[index]

    @cached_property
    def flexible_rods(self) -> IntArray:
        """Rods split by a flexure: (f,) indices, ascending."""
        every = np.arange(len(self.structure.rods))
        kinds = {"all": every, "active": self.active_rods, "passive": np.setdiff1d(every, self.active_rods)}
        return frozen(kinds[self.flexure.rods] if self.flexure else every[:0])

    @cached_property
    def rod_compressions(self) -> FloatArray:
        """(r,) force along each rod at rest, positive in compression [N]."""
        if len(self.standing.shared):
            return frozen(shared_compressions(self.standing, self.rest_tensions))
        lengths = self.standing.lengths(self.standing.cables)
        stretch = lengths - 2 * self.attachment_radius - self.cable_natural_lengths
        return frozen(compressions(self.standing, column(self.each_cable, "stiffness") * stretch))

    def half_length(self, rod: int) -> float:
        """Of the tube on either side of a split rod's hinge [m]. Raises DesignError when the hinge fills the rod."""
        assert self.flexure is not None
        return half_length(self.flexure, float(self.standing.rod_lengths[rod]))

    def buckling_load(self, rod: int) -> float:
        """Compression under which a split rod bends out of line [N]."""
        assert self.flexure is not None
        return split_buckling_load(self.flexure, float(self.standing.rod_lengths[rod]))

    @property
    def rod_pins(self) -> dict[int, RodPin]:
        """Of each split rod, by its index, the pin and the torsion spring that stand for its hinge: fitted under the
        rod's prestress where the design is made."""
        return self._rod_pins  # type: ignore[attr-defined]

    @property
    def cable_natural_lengths(self) -> FloatArray:
        """(c,) between attachment points [m]."""
        cables = self.each_cable
        given = np.array([np.nan if c.natural_length is None else c.natural_length for c in cables], dtype=float)
        rest = self.standing.lengths(self.standing.cables) - 2 * self.attachment_radius
        found = rest - self.rest_tensions / column(cables, "stiffness")
        return np.where(np.isnan(given), found, given - 2 * self.attachment_radius)

    @property
    def stiff_cable_lengths(self) -> FloatArray:
        """(w,) between attachment points at rest, where they are just slack [m]."""
        return self.standing.lengths(self.standing.stiff_cables) - 2 * self.attachment_radius

    @property
    def payload_natural_length(self) -> float:
        """Of the payload's cables, from a rod's mid-point to the ball's surface [m]."""
        assert self.payload is not None
        middles = self.standing.nodes[self.standing.rods].mean(axis=1)
        return self.payload.tied_length(float(np.linalg.norm(middles - middles.mean(axis=0), axis=1).min()))

    @property
    def mass(self) -> float:
        """Whole robot [kg]."""
        rods = sum(self.rod(i).mass for i in range(len(self.structure.rods)))
        return rods + (self.payload.mass if self.payload else 0.0)

    @property
    def length(self) -> float:
        """L, the longest rod [m]: the unit of gait speeds."""
        return float(self.built.rod_lengths.max())

    def with_(self, **changes: object) -> RobotDesign:
        """A copy with some fields replaced, validated again."""
        return replace(self, **changes)  # type: ignore[arg-type]


def paper_design() -> RobotDesign:
    """The paper's robot as its authors' model has it: no self-stress, so its springs push as well as pull."""
    return RobotDesign(
        structure=structures.paper(),
        name="paper",
        form_finding=False,
        elastic_cable=ElasticCable(damping=150.0, pretension=1.0, natural_length=0.46806, two_way=True),
        drive=Drive(voltage_limit=10.8),
        attachment_radius=0.0,
        spin_damping=1e-4,
    )


def flexible_design() -> RobotDesign:
    """The six-rod robot with its three passive rods split by leaf springs."""
    return RobotDesign(name="six_rod_flexible", flexure=RodFlexure())


PRESETS = {"six_rod": RobotDesign, "paper": paper_design, "six_rod_flexible": flexible_design}
