"""What NTRT's builders say of rods and cables, in SI units."""

from __future__ import annotations

from typing import Any, NamedTuple

from tensegym.errors import InputError
from tensegym.tables import as_number, known, mapping, one_line, show

RODS = ("tgRodInfo",)
CABLES = ("tgBasicActuatorInfo", "tgBasicContactCableInfo", "tgKinematicActuatorInfo", "tgKinematicContactCableInfo")
_ROD = {"radius": 0.5, "density": 1.0, "friction": 1.0}  # NTRT's own where a file gives none, in its units
_CABLE = {"stiffness": 1000.0, "damping": 10.0, "pretension": 0.0}
_LEFT_OUT = {  # what else they may hold, for which a design has no place
    "rod": ("roll_friction", "restitution"),
    "cable": ("history", "max_tension", "target_velocity", "min_actual_length", "min_rest_length", "rotation", "radius",
              "motor_friction", "motor_inertia", "back_drivable", "moveCablePointAToEdge", "moveCablePointBToEdge"),
}  # fmt: skip


class RodKind(NamedTuple):
    """A rod: a solid cylinder."""

    radius: float
    """[m]."""
    density: float
    """[kg/m^3]."""
    friction: float


class CableKind(NamedTuple):
    """A cable: stiffness [N/m], damping [N s/m], pretension [N]."""

    stiffness: float
    damping: float
    pretension: float


class Builders(NamedTuple):
    """By tag; and the names of parameters that were left out."""

    rods: dict[str, RodKind]
    cables: dict[str, CableKind]
    left_out: tuple[str, ...]


def read_builders(data: dict[Any, Any], unit: float) -> Builders:
    """Of a model's builders, and the two that NTRT has where a file gives none, ``rod`` and ``string``.

    Mass is in kg; a force is in kg units/s^2, so that stiffness and damping are the same in any unit of length.

    Args:
        data: the tables of builders by their tags.
        unit: of length [m].

    Raises:
        InputError: a class of bodies that a design has not, or a parameter that is unknown or no number, by tag.
    """
    rods, cables, left_out = dict[str, RodKind](), dict[str, CableKind](), set[str]()
    given = {"rod": {"class": RODS[0]}, "string": {"class": CABLES[0]}} | data
    for tag, table in ((str(tag), table) for tag, table in given.items()):
        where = f"builder {show(tag)}"
        kind = known(table, ("class", "parameters"), where, InputError).get("class")
        own = mapping(table.get("parameters") or {}, f"{where}: parameters", InputError)
        if kind not in (*RODS, *CABLES):
            raise InputError(one_line(f"{where}: class = {show(kind)} is no rod and no cable; a design has "
                                      f"{', '.join((*RODS, *CABLES[:1]))}"))  # fmt: skip
        name, defaults = ("rod", _ROD) if kind in RODS else ("cable", _CABLE)
        known(own, (*defaults, *_LEFT_OUT[name]), f"{where}: parameters", InputError)
        left_out |= own.keys() - defaults.keys()
        value = {key: as_number(own.get(key, usual), f"{where}: {key}", InputError) for key, usual in defaults.items()}
        if min(value.values()) < 0:
            raise InputError(one_line(f"{where}: {min(value, key=lambda key: value[key])} is below 0"))
        if name == "rod":
            rods[tag] = RodKind(value["radius"] * unit, value["density"] / unit**3, value["friction"])
        else:
            cables[tag] = CableKind(value["stiffness"], value["damping"], value["pretension"] * unit)
    return Builders(rods, cables, tuple(sorted(left_out)))
