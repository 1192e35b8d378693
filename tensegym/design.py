"""RobotDesign: every physical parameter of a robot, validated where it is made. SI units throughout."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace

import numpy as np

from . import structure as structures
from .equilibrium import check_balance, form_find
from .errors import DesignError
from .structure import FloatArray, IntArray, Structure


def bounded(low: float, high: float, default: float, unit: str, what: str, *, open_low: bool = False):
    """A dataclass field holding a float in [low, high], or (low, high] with ``open_low``."""
    return field(default=default, metadata={"low": low, "high": high, "open_low": open_low, "unit": unit, "what": what})


def check_ranges(group: object) -> None:
    """Raise DesignError naming the first field of a dataclass that is no finite number in its range."""
    for f in fields(group):  # type: ignore[arg-type]
        if "low" not in f.metadata:
            continue
        value, low, high = getattr(group, f.name), f.metadata["low"], f.metadata["high"]
        number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
        inside = number and low <= value <= high and not (f.metadata["open_low"] and value == low)
        if not inside:
            bracket = "(" if f.metadata["open_low"] else "["
            allowed = f"{bracket}{low:g}, {high:g}] {f.metadata['unit']}".rstrip()
            raise DesignError(f"{type(group).__name__}.{f.name} = {value!r} is outside {allowed}")


class Checked:
    """Base of the parameter groups: ranges are checked on construction."""

    def __post_init__(self) -> None:
        check_ranges(self)


@dataclass(frozen=True)
class Rod(Checked):
    """A rod: a tube with an equal lumped mass at each end and a spherical foot."""

    tube_mass: float = bounded(0, 100, 0.028, "kg", "mass of the tube", open_low=True)
    end_mass: float = bounded(0, 100, 0.05, "kg", "mass at each end")
    tube_outer_radius: float = bounded(1e-4, 0.2, 0.004, "m", "outer radius, and that of the collision capsule")
    tube_inner_radius: float = bounded(0, 0.2, 0.003, "m", "inner radius")
    end_mass_radius: float = bounded(1e-4, 0.2, 0.01, "m", "radius of the solid ball each end mass is taken as")
    foot_radius: float = bounded(1e-4, 0.2, 0.004, "m", "contact sphere at each end")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.tube_inner_radius >= self.tube_outer_radius:
            raise DesignError(
                f"Rod.tube_inner_radius = {self.tube_inner_radius!r} must be below "
                f"tube_outer_radius = {self.tube_outer_radius!r} m"
            )

    @property
    def mass(self) -> float:
        """Whole rod [kg]."""
        return self.tube_mass + 2 * self.end_mass

    @property
    def axial_inertia(self) -> float:
        """About the rod's axis [kg m^2]."""
        tube = 0.5 * self.tube_mass * (self.tube_outer_radius**2 + self.tube_inner_radius**2)
        return tube + 2 * 0.4 * self.end_mass * self.end_mass_radius**2

    def transverse_inertia(self, length: float) -> float:
        """About an axis through the centre across the rod [kg m^2], for a rod of this length [m]."""
        tube = self.tube_mass * (length**2 / 12 + (self.tube_outer_radius**2 + self.tube_inner_radius**2) / 4)
        return tube + 2 * self.end_mass * (0.4 * self.end_mass_radius**2 + length**2 / 4)


@dataclass(frozen=True)
class ElasticCable(Checked):
    """The elastic cables: spring-dampers, tension only unless ``two_way``."""

    stiffness: float = bounded(0, 1e6, 300.0, "N/m", "spring rate", open_low=True)
    damping: float = bounded(0, 1e4, 5.0, "N s/m", "damper rate")
    pretension: float = bounded(0, 1e4, 10.0, "N", "tension at rest, which sets the natural length")
    natural_length: float | None = None  # m; given, it overrides the pretension (the paper's way)
    two_way: bool = False  # the paper's springs push as well as pull

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.natural_length is not None and not 0 < self.natural_length < 100:
            raise DesignError(f"ElasticCable.natural_length = {self.natural_length!r} is outside (0, 100] m")


@dataclass(frozen=True)
class StiffCable(Checked):
    """The cables the drives wind."""

    stiffness: float = bounded(0, 1e6, 2e4, "N/m", "spring rate", open_low=True)
    damping: float = bounded(0, 1e4, 20.0, "N s/m", "damper rate")
    max_pull: float = bounded(0, 0.9, 0.45, "", "deepest commanded pull, as a part of the cable's rest length",
                              open_low=True)


@dataclass(frozen=True)
class Drive(Checked):
    """A winch drive: brushless motor, rotor angle sensor, gear, spool, and its angle controller."""

    spool_radius: float = bounded(1e-4, 1, 0.003, "m", "radius of the spool")
    gear_ratio: float = bounded(1, 1e4, 19.0, "", "rotor turns a spool turn")
    gear_efficiency: float = bounded(0.05, 1, 0.81, "", "part of the power that passes the gear")
    backlash: float = bounded(0, 1, 0.0279, "rad", "play at the spool")
    resistance: float = bounded(1e-3, 1e4, 5.3, "ohm", "winding")
    torque_constant: float = bounded(1e-5, 10, 9.32e-3, "N m/A", "also the back-emf constant in V s/rad")
    rotor_inertia: float = bounded(1e-10, 1, 0.85e-7, "kg m^2", "motor's rotor")
    friction_current: float = bounded(0, 100, 0.0, "A", "current that turns the unloaded rotor")
    voltage_limit: float = bounded(0, 1e3, 11.62, "V", "largest voltage of the controller", open_low=True)
    current_limit: float = bounded(0, 1e3, 1.72, "A", "largest current of the controller", open_low=True)
    speed_limit: float = bounded(0, 1e5, 1246.2, "rad/s", "largest rotor speed (11900 rpm)", open_low=True)
    position_gain: float = bounded(0, 1e3, 1.25, "V/rad", "controller: voltage a radian of rotor error", open_low=True)
    velocity_gain: float = bounded(0, 10, 0.0, "V s/rad", "controller: voltage taken off a rad/s of rotor speed")


@dataclass(frozen=True)
class Payload(Checked):
    """A ball in the middle, hung on one elastic cable from every rod's mid-point."""

    mass: float = bounded(0, 100, 0.5, "kg", "payload", open_low=True)
    radius: float = bounded(1e-3, 10, 0.1, "m", "ball; the cables end on its surface")
    stiffness: float = bounded(0, 1e6, 120.0, "N/m", "spring rate", open_low=True)
    damping: float = bounded(0, 1e4, 5.0, "N s/m", "damper rate")
    pretension: float = bounded(0, 1e4, 4.0, "N", "tension at rest")
    natural_length: float | None = None  # m; given, it overrides the pretension
    two_way: bool = False


@dataclass(frozen=True)
class RobotDesign:
    """Every physical parameter of a robot. `standing` is the structure it is built in.

    Raises DesignError or StructureError, naming field, value and allowed range.
    """

    structure: Structure = field(default_factory=structures.six_rod)
    name: str = "six_rod"
    form_finding: bool = True  # repair the nodes so that the pretension balances; otherwise they must balance as given
    passive_rod: Rod = Rod()
    active_rod: Rod = Rod(tube_mass=0.038, end_mass=0.2, end_mass_radius=0.016)
    elastic_cable: ElasticCable = ElasticCable()
    stiff_cable: StiffCable = StiffCable()
    drive: Drive = Drive()
    payload: Payload | None = None
    attachment_radius: float = bounded(0, 0.1, 0.004, "m", "cables are tied this far from the rod's axis")
    spin_damping: float = bounded(0, 1, 1e-4, "N m s/rad", "resists a rod's spin about its own axis")
    friction: float = bounded(0, 10, 0.8, "", "Coulomb coefficient, feet and rods against ground and each other")
    gravity: float = bounded(0, 100, 9.81, "m/s^2", "downward")

    def __post_init__(self) -> None:
        check_ranges(self)
        standing = self.structure
        if self.elastic_cable.natural_length is None:
            if self.form_finding:
                standing = form_find(
                    standing, self.elastic_cable.pretension,
                    payload_tension=self.payload.pretension if self.payload else 0.0,
                )
            else:
                check_balance(standing, self.elastic_cable.pretension)
        object.__setattr__(self, "_standing", standing)
        shortest = standing.lengths(standing.cables).min(initial=1.0) - 2 * self.attachment_radius
        if self.cable_natural_lengths.min(initial=1.0) <= 0:
            limit = self.elastic_cable.stiffness * shortest
            raise DesignError(
                f"ElasticCable.pretension = {self.elastic_cable.pretension!r} stretches a cable of {shortest:.4g} m "
                f"from nothing; at stiffness {self.elastic_cable.stiffness:g} N/m it must be below {limit:.4g} N"
            )
        if self.payload is not None and self.payload_natural_length <= 0:
            raise DesignError(
                f"Payload.pretension = {self.payload.pretension!r} leaves its cables no natural length "
                f"({self.payload_natural_length:.4g} m); lower the pretension or the radius, or raise the stiffness"
            )

    @property
    def standing(self) -> Structure:
        """The structure at rest: form-found, or as given."""
        return self._standing  # type: ignore[attr-defined]

    @property
    def active_rods(self) -> IntArray:
        """Rods that carry drives: (a,) indices, ascending."""
        driven = np.isin(self.structure.rods, self.structure.stiff_cables[:, 0]).any(axis=1)
        return np.flatnonzero(driven)

    def rod(self, index: int) -> Rod:
        """The kind of rod at this index."""
        return self.active_rod if index in self.active_rods else self.passive_rod

    @property
    def cable_natural_lengths(self) -> FloatArray:
        """(c,) between attachment points [m]."""
        cable = self.elastic_cable
        count = len(self.structure.cables)
        if cable.natural_length is not None:
            return np.full(count, cable.natural_length - 2 * self.attachment_radius)
        rest = self.standing.lengths(self.standing.cables) - 2 * self.attachment_radius
        return rest - cable.pretension / cable.stiffness

    @property
    def stiff_cable_lengths(self) -> FloatArray:
        """(w,) between attachment points at rest, where they are just slack [m]."""
        return self.standing.lengths(self.standing.stiff_cables) - 2 * self.attachment_radius

    @property
    def payload_natural_length(self) -> float:
        """Of the payload's cables, from a rod's mid-point to the ball's surface [m]."""
        assert self.payload is not None
        if self.payload.natural_length is not None:
            return self.payload.natural_length
        nodes, rods = self.standing.nodes, self.standing.rods
        middles = nodes[rods].mean(axis=1)
        reach = np.linalg.norm(middles - middles.mean(axis=0), axis=1).min()
        return reach - self.payload.radius - self.payload.pretension / self.payload.stiffness

    @property
    def mass(self) -> float:
        """Whole robot [kg]."""
        rods = sum(self.rod(i).mass for i in range(len(self.structure.rods)))
        return rods + (self.payload.mass if self.payload else 0.0)

    @property
    def length(self) -> float:
        """L, the longest rod [m]: the unit of gait speeds."""
        return float(self.structure.rod_lengths.max())

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


PRESETS = {"six_rod": RobotDesign, "paper": paper_design}
