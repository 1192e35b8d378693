"""Disturbance: how far a robot, its sensors and its world may be from what was designed, drawn anew each episode."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tensegym.design.design import RobotDesign
from tensegym.design.groups import scaled as scaled_groups
from tensegym.errors import DesignError, TensegymError
from tensegym.robot.sensors import Error, Sensors
from tensegym.tables import Checked, bounded, one_line

TRIES = 100  # draws in a row that may all be refused
_PARTS = ("stiffness", "pretension", "mass", "friction", "drive", "voltage")


@dataclass(frozen=True, kw_only=True)
class Disturbance(Checked, error=DesignError):
    """Ranges of what goes otherwise than designed; everything off by default.

    The first six are drawn uniformly within so large a part of the designed value on either side, one number for the
    whole robot. Noise is drawn at each observation and a bias once an episode, both normally, for each entry. Which
    drives and cables fail is drawn; a drive does so when the episode begins.
    """

    stiffness: float = bounded(0, 0.9, 0.0, "", "elastic cables' and the payload's, up to this part more or less")
    pretension: float = bounded(0, 0.9, 0.0, "", "the same of their tension at rest")
    mass: float = bounded(0, 0.9, 0.0, "", "of rods, their ends and the payload")
    friction: float = bounded(0, 0.9, 0.0, "", "of the ground")
    drive: float = bounded(0, 0.9, 0.0, "", "of the drives' current limit, and so of their torque")
    voltage: float = bounded(0, 0.9, 0.0, "", "of the drives' voltage limit")
    attitude_noise: float = bounded(0, 1, 0.0, "rad", "of the inertial units' attitude, in each entry of a rod's axis")
    attitude_bias: float = bounded(0, 1, 0.0, "rad", "the same, for a whole episode")
    rate_noise: float = bounded(0, 10, 0.0, "rad/s", "of the inertial units' turn rate")
    rate_bias: float = bounded(0, 10, 0.0, "rad/s", "the same, for a whole episode")
    encoder_noise: float = bounded(0, 10, 0.0, "rad", "of the drives' angle, at the spool")
    encoder_bias: float = bounded(0, 10, 0.0, "rad", "the same, for a whole episode")
    seen_late: int = bounded(0, 2, 0, "", "control steps that an observation comes late, at most")
    done_late: int = bounded(0, 2, 0, "", "control steps that a command comes late, at most")
    pushes: float = bounded(0, 600, 0.0, "1/min", "how often the robot is pushed")
    push: float = bounded(0, 5, 0.2, "m/s", "velocity that a push gives the whole robot, sideways")
    weak: int = bounded(0, 1000, 0, "", "drives that give a part of their torque")
    weak_to: float = bounded(0, 1, 0.5, "", "this part", open_high=True)
    stuck: int = bounded(0, 1000, 0, "", "drives that cannot turn")
    dead: int = bounded(0, 1000, 0, "", "drives without voltage")
    snapped: int = bounded(0, 1000, 0, "", "elastic cables that snap")
    snap_by: float = bounded(0, 3600, 0.0, "s", "each at a time drawn up to this one")
    faulty: float = bounded(0, 1, 1.0, "", "how likely each of these drives and cables is to fail in an episode")
    cables: tuple[int, ...] = bounded(1, 10_000, (), "", "elastic cables that snap at the start, by number from 1")

    @property
    def on(self) -> bool:
        """Whether anything is."""
        plain = vars(Disturbance(push=self.push, weak_to=self.weak_to, snap_by=self.snap_by, faulty=self.faulty))
        return plain != vars(self)

    @property
    def rebuilds(self) -> bool:
        """Whether the robot is another one each episode."""
        return any(getattr(self, name) for name in _PARTS)

    def check(self, design: RobotDesign) -> None:
        """Raises DesignError where a design has not so many drives or cables, or no such cable."""
        drives, cables = len(design.structure.stiff_cables), len(design.structure.cables)
        for name, count, have in (("weak + stuck + dead", self.weak + self.stuck + self.dead, drives),
                                  ("snapped", self.snapped, cables)):  # fmt: skip
            if count > have:
                what = "drives" if have == drives else "elastic cables"
                raise DesignError(f"Disturbance: {name} = {count}, but {design.name!r} has {have} {what}; "
                                  "give at most that")  # fmt: skip
        missing = [number for number in self.cables if number > cables]
        if missing:
            raise DesignError(f"Disturbance.cables: there is no elastic cable {missing[0]} in {design.name!r}; "
                              f"give numbers from 1 to {cables}")  # fmt: skip

    def draw(self, design: RobotDesign, rng: np.random.Generator) -> tuple[RobotDesign, dict[str, float]]:
        """A robot as it was built, not as it was designed, and the factors that it is off by.

        Raises:
            DesignError: none of many that were drawn can be built.
        """
        for _ in range(TRIES):
            factors = {name: 1 + float(rng.uniform(-1, 1)) * getattr(self, name) for name in _PARTS}
            try:
                return _built(design, factors), factors
            except TensegymError as error:
                refused = error
        raise DesignError(one_line(f"Disturbance: {TRIES} robots drawn were all refused, the last one: {refused}"))

    def sensors(self, rng: np.random.Generator) -> Sensors:
        """Those of an episode."""
        errors = {
            "rod axis": Error(self.attitude_noise, self.attitude_bias),
            "rod rate": Error(self.rate_noise, self.rate_bias),
            "drive angle": Error(self.encoder_noise, self.encoder_bias),
        }
        late = int(rng.integers(self.seen_late + 1))
        return Sensors({name: error for name, error in errors.items() if any(error)}, late, rng)


def _built(design: RobotDesign, factors: dict[str, float]) -> RobotDesign:
    def scaled(group: Any, **by: float) -> Any:
        return replace(group, **{name: getattr(group, name) * factor for name, factor in by.items()})

    cable = {"stiffness": factors["stiffness"], "pretension": factors["pretension"]}
    rod = {"tube_mass": factors["mass"], "end_mass": factors["mass"]}
    torque = {"current_limit": factors["drive"], "voltage_limit": factors["voltage"]}
    return design.with_(
        cables=scaled_groups(design.cables, cable),
        rods=scaled_groups(design.rods, rod),
        drives=scaled_groups(design.drives, torque),
        elastic_cable=scaled(design.elastic_cable, **cable),
        active_rod=scaled(design.active_rod, **rod),
        passive_rod=scaled(design.passive_rod, **rod),
        payload=scaled(design.payload, **cable, mass=factors["mass"]) if design.payload else None,
        drive=scaled(design.drive, **torque),
        friction=design.friction * factors["friction"],
    )
