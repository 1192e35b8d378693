"""Labels: metrics and parameters as a figure's axes name them, in words with their units."""

from __future__ import annotations

from typing import Any

from tensegym.design.parameters import Drive, ElasticCable, Payload, Rod, RodFlexure, StiffCable
from tensegym.tables import describe

_METRICS = {
    "duration": "duration [s]", "speed": "speed [m/s]", "speed_lps": "speed [rod lengths/s]", "path": "path [m]",
    "slip_share": "slip, share of the way", "slip_share_sum": "slip of all feet, share of the way",
    "energy": "electrical energy [J]", "drive_work": "work of the drives [J]", "peak_tension": "peak tension [N]",
    "drive_load": "drive load, share of the current limit", "mass": "mass [kg]", "weight": "weight [N]",
    "audit_excess": "excess of the energy audit, share", "cross_track": "distance from the path [rod lengths]",
    "path_speed": "speed along the path [rod lengths/s]", "leg_speed": "speed of a leg [rod lengths/s]",
    "passing_time": "passing time [s]", "followed": "share of the path come along",
}  # fmt: skip
_GROUPS: dict[str, type[Any]] = {
    "passive_rod": Rod, "active_rod": Rod, "elastic_cable": ElasticCable, "stiff_cable": StiffCable, "drive": Drive,
    "payload": Payload, "flexure": RodFlexure,
}  # fmt: skip
_OTHERS = {
    "design.structure.rod_length": "m", "controller.period": "s", "controller.frequency": "Hz",
    "controller.pull_time": "s",
}  # fmt: skip


def metric_label(metric: str) -> str:
    """What a metric is and its unit; the words of its name where it has none."""
    return _METRICS.get(metric, metric.replace("_", " "))


def parameter_label(name: str) -> str:
    """A dimension of a space, as ``design.elastic_cable.stiffness``: elastic cable: stiffness [N/m]."""
    words = name.removeprefix("design.").split(".")
    unit = _OTHERS.get(name, "")
    if len(words) == 2 and words[0] in _GROUPS:
        unit = next((row.unit for row in describe(_GROUPS[words[0]]) if row.field == words[1]), "")
    label = ": ".join(words).replace("_", " ")
    return f"{label} [{unit}]" if unit else label
