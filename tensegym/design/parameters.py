"""Groups of physical parameters, each checked where it is made. SI units throughout."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from tensegym.errors import DesignError, FlexureError
from tensegym.structure.structure import ROD_LENGTHS
from tensegym.tables import Checked, as_whole_rows, bounded, choice, noted, one_line

if TYPE_CHECKING:
    from tensegym.flexure.hinge import Hinge


@dataclass(frozen=True)
class Rod(Checked, error=DesignError):
    """A rod: a tube with an equal lumped mass at each end and a spherical foot."""

    tube_mass: float = bounded(0, 100, 0.028, "kg", "mass of the tube", open_low=True)
    end_mass: float = bounded(0, 100, 0.05, "kg", "mass at each end")
    tube_outer_radius: float = bounded(1e-4, 0.2, 0.004, "m", "outer radius, and that of the collision capsule")
    tube_inner_radius: float = bounded(0, 0.2, 0.003, "m", "inner radius")
    end_mass_radius: float = bounded(1e-4, 0.2, 0.01, "m", "radius of the solid ball each end mass is taken as")
    foot_radius: float = bounded(1e-4, 0.2, 0.004, "m", "contact sphere at each end")
    length: float | None = bounded(ROD_LENGTHS.low, ROD_LENGTHS.high, None, "m",
                                   "given, it overrides the distance between the rod's nodes")

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

    def half(self, length: float) -> HalfRod:
        """Half of the rod with a tube of this length [m]: half the tube's mass, one end mass, one foot."""
        tube = self.tube_mass / 2
        mass = tube + self.end_mass
        centre = tube * length / 2 / mass
        across = tube * (length**2 / 12 + (self.tube_outer_radius**2 + self.tube_inner_radius**2) / 4)
        across += tube * (length / 2 - centre) ** 2 + self.end_mass * (0.4 * self.end_mass_radius**2 + centre**2)
        return HalfRod(mass, centre, across, self.axial_inertia / 2)


@dataclass(frozen=True)
class HalfRod:
    """Mass [kg], distance of the centre of mass from the outer end [m], moments of inertia about it [kg m^2]."""

    mass: float
    centre: float
    transverse_inertia: float
    axial_inertia: float


@dataclass(frozen=True)
class ElasticCable(Checked, error=DesignError):
    """The elastic cables: spring-dampers, tension only unless ``two_way``."""

    stiffness: float = bounded(0, 1e6, 300.0, "N/m", "spring rate of every elastic cable; of some, see [cables.NAME]",
                               open_low=True)
    damping: float = bounded(0, 1e4, 5.0, "N s/m", "damper rate of every elastic cable; of some, see [cables.NAME]")
    pretension: float = bounded(0, 1e4, 10.0, "N", "tension at rest of every elastic cable, which sets its length; "
                                "of some, see [cables.NAME]")
    natural_length: float | None = bounded(0, 100, None, "m", "given, it overrides the pretension (the paper's way)",
                                           open_low=True)
    force_density: float | None = bounded(0, 1e6, None, "N/m", "tension over length at rest; given, it overrides the "
                                          "pretension", open_low=True)
    two_way: bool = noted(False, "push as well as pull, as the paper's springs do")


@dataclass(frozen=True)
class Keep(Checked, error=DesignError):
    """What form finding leaves as it is given; tensions change instead: those of the groups of cables or, without any,
    all of them."""

    shape: bool = noted(False, "all nodes: tensions that hold them are found, nearest to the pretension")
    nodes: tuple[int, ...] = bounded(1, 100_000, (), "", "these nodes, by number from 1, stay where they are")
    height: bool = noted(False, "the lowest and the highest nodes keep their heights")
    lengths: tuple[tuple[int, ...], ...] = noted((), "pairs of nodes, by number from 1, that keep their distance")

    def __post_init__(self) -> None:
        super().__post_init__()
        pairs = as_whole_rows(self.lengths, 2, "Keep.lengths", DesignError, "two node numbers")
        object.__setattr__(self, "lengths", tuple(map(tuple, pairs.tolist())))


@dataclass(frozen=True)
class StiffCable(Checked, error=DesignError):
    """The cables the drives wind."""

    stiffness: float = bounded(0, 1e6, 2e4, "N/m", "spring rate", open_low=True)
    damping: float = bounded(0, 1e4, 20.0, "N s/m", "damper rate")
    max_pull: float = bounded(0, 0.9, 0.45, "", "deepest commanded pull, as a part of the cable's rest length",
                              open_low=True)


@dataclass(frozen=True)
class Drive(Checked, error=DesignError):
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

    @property
    def torque_limit(self) -> float:
        """What the spool winds against at the current limit, the gear's losses taken off [N m]."""
        return self.current_limit * self.torque_constant * self.gear_ratio * self.gear_efficiency


@dataclass(frozen=True)
class Payload(Checked, error=DesignError):
    """A ball in the middle, hung on one elastic cable from every rod's mid-point."""

    mass: float = bounded(0, 100, 0.5, "kg", "payload", open_low=True)
    radius: float = bounded(1e-3, 10, 0.1, "m", "ball; the cables end on its surface")
    stiffness: float = bounded(0, 1e6, 120.0, "N/m", "spring rate", open_low=True)
    damping: float = bounded(0, 1e4, 5.0, "N s/m", "damper rate")
    pretension: float = bounded(0, 1e4, 4.0, "N", "tension at rest")
    natural_length: float | None = bounded(0, 100, None, "m", "given, it overrides the pretension", open_low=True)
    two_way: bool = noted(False, "push as well as pull")

    def tied_length(self, reach: float) -> float:
        """Natural length [m] of its cables, which end on its surface, with the nearest rod at ``reach`` [m]."""
        given = self.natural_length
        return reach - self.radius - self.pretension / self.stiffness if given is None else given


@dataclass(frozen=True)
class RodFlexure(Checked, error=DesignError):
    """A flexure hinge that splits rods at mid-length: they bend in one plane, about a pin with a spring fitted to it.

    ``hinge`` is a preset of tensegym.flexure.presets; a dimension left out keeps that preset's own. The pin and its
    spring come from the hinge's finite elements (tensegym.flexure.models.rod_pin); the other five directions are held.
    """

    rods: str = choice("passive", "active", "all", what="which rods are split")
    hinge: str = noted("leaf-spring", "a preset hinge")
    plane: str = choice("radial", "tangential",
                        what="where they bend: in the plane through the robot's centre, or in the one across it")
    length: float = bounded(1e-3, 0.5, 0.04, "m", "of the hinge along the rod")
    width: float = bounded(1e-4, 0.5, 0.025, "m", "of the leaves, across the plane of bending")
    thickness: float = bounded(1e-5, 0.02, 0.0011, "m", "of the leaves")
    height: float | None = bounded(0, 0.5, None, "m", "of hinges that have one; else the preset's own", open_low=True)
    youngs_modulus: float = bounded(1e6, 1e12, 2.1e11, "Pa", "of the leaves: spring steel")
    poisson_ratio: float = bounded(0, 0.49, 0.3, "", "of the leaves")
    loss_time: float = bounded(0, 1, 1e-3, "s", "Kelvin-Voigt: damping over stiffness")
    max_angle: float = bounded(1e-3, 1.5, 0.3, "rad", "stops of the rod, and range of the spring's fit")

    def __post_init__(self) -> None:
        super().__post_init__()
        try:
            self.geometry()
        except FlexureError as error:
            raise DesignError(one_line(f"RodFlexure: {error}")) from error

    def geometry(self) -> Hinge:
        """The hinge, for the finite elements. Raises FlexureError for an unknown one or sizes that make none."""
        from tensegym.flexure.hinge import Material, preset

        sizes = {"length": self.length, "width": self.width, "thickness": self.thickness}
        if self.height is not None:
            sizes["height"] = self.height
        hinge = preset(self.hinge, **sizes, arm=0.0)
        return hinge.with_material(Material(self.youngs_modulus, self.poisson_ratio))
