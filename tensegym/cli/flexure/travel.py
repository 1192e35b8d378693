"""`tensegym flexure travel`: stiffness, stress and buckling along a hinge's travel."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import tyro

from tensegym.arrays import FloatArray
from tensegym.cli.options import Within
from tensegym.errors import InputError
from tensegym.files import check_file
from tensegym.flexure.fem.mesh_error import too_coarse_for
from tensegym.flexure.fem.travel import TURN, Y, pushed, turned
from tensegym.flexure.fem.travel import Travel as Path_
from tensegym.flexure.hinge import Hinge
from tensegym.flexure.hinge.presets import MM
from tensegym.plotting import require_matplotlib
from tensegym.report import Report, table

from .hinge_options import HingeOptions
from .travel_figure import draw_travel

GUIDE_ANGLE = 0.1  # degrees: a hinge that turns less is a guide and is pushed
SHARE = 0.1  # of L that a guide is pushed without --travel-mm


@dataclass(frozen=True)
class Travel:
    """Stiffness in and out of plane, stress of the extreme fibre and buckling of a hinge along its travel.

    A hinge is turned by a force across its arm's end (a pure moment where it has no arm); a guide, or any hinge with
    --travel-mm, is pushed along y.
    """

    hinge: tyro.conf.Positional[str]
    """A preset or a TOML file."""
    out: Path | None = None
    """Picture to write (PNG)."""
    options: HingeOptions = field(default_factory=HingeOptions)
    max_angle_deg: Annotated[float, Within(0.0, 90.0, "deg")] | None = None
    """How far to turn; default: the hinge's own."""
    travel_mm: Annotated[float, Within(0.0, 1e5, "mm")] | None = None
    """How far to push along y instead; a guide's default is L/10."""
    axial_N: Annotated[float, Within(-1e6, 1e6, "N")] = 0.0
    """Dead force at the tip along x besides; negative pushes the hinge together."""
    strength_MPa: Annotated[float, Within(0.0, 1e6, "MPa")] | None = None
    """Stress that the material bears: the table then says how much of it is used."""
    points: Annotated[int, Within(2, 1000)] = 11
    """States from rest to the end."""
    elements: Annotated[int, Within(1, 1000)] = 16
    """Beam elements a leaf of length L."""

    def run(self) -> Report:
        if self.out is not None:
            check_file(self.out)
            require_matplotlib()
        if self.strength_MPa == 0:
            raise InputError("strength_MPa = 0; give a stress above 0")
        hinge = self.options.apply(self.hinge)
        along = self._along(hinge)
        path, heading = self._path(hinge, along)
        header, columns = _columns(path, self.strength_MPa)
        lines = [f"{hinge.describe()}; {heading}", table(header, _rows(columns))]
        lines += [f"note: {note}" for note in self._notes(hinge, path)]
        if self.out is not None:
            draw_travel(path, hinge, heading, self.out)
            lines.append(f"drawn: {self.out}")
        return Report("\n".join(lines), self._facts(hinge, path, heading))

    def _along(self, hinge: Hinge) -> str:
        """What is driven."""
        if self.travel_mm is not None:
            if self.max_angle_deg is not None:
                raise InputError("give one of --travel-mm (pushed along y) and --max-angle-deg (turned)")
            return "y"
        guide = math.degrees(hinge.max_angle) < GUIDE_ANGLE
        return "y" if guide and self.max_angle_deg is None else "turn"

    def _path(self, hinge: Hinge, along: str) -> tuple[Path_, str]:
        steps = np.linspace(0, 1, self.points)
        axial = f", {self.axial_N:g} N along x" if self.axial_N else ""
        if along == "y":
            reach = SHARE * hinge.length if self.travel_mm is None else MM * self.travel_mm
            if not reach > 0:
                raise InputError("travel_mm = 0; give a travel above 0")
            path = pushed(hinge, reach * steps, axial=self.axial_N, elements=self.elements)
            return path, f"pushed along y at the tip{axial}"
        reach = hinge.max_angle if self.max_angle_deg is None else math.radians(self.max_angle_deg)
        if not reach > 0:
            raise InputError("max_angle_deg = 0; give an angle above 0")
        path = turned(hinge, reach * steps, axial=self.axial_N, elements=self.elements)
        how = f"a force in y at the end of the {hinge.arm / MM:g} mm arm" if hinge.arm else "a pure moment"
        return path, f"turned by {how}{axial}"

    def _notes(self, hinge: Hinge, path: Path_) -> list[str]:
        held = {Y: "k x with y held and the turn free, k turn with y held", TURN: "k x and k y with the turn held"}
        notes = [f"k {_NAMES[path.driven]} drives the path, others free; {held[path.driven]}; out of plane an "
                 "approximation, each with the others free"]  # fmt: skip
        wrench = np.column_stack([path.states.force, path.states.moment])[-1:]
        coarse = too_coarse_for(hinge, wrench, self.elements)
        most = max(stress.size for stress in path.stress) / 1e6
        if self.strength_MPa is not None and most > self.strength_MPa:
            notes.append(f"the stress reaches {most:.4g} MPa, above strength_MPa = {self.strength_MPa:g}: lower the "
                         "travel or the thickness")  # fmt: skip
        least = float(path.load_factor.min())
        if least < 1:
            notes.append(f"buckled: at the worst state {least:.3g} of its load is what the hinge bears")
        return [*notes, *([coarse] if coarse else [])]

    def _facts(self, hinge: Hinge, path: Path_, heading: str) -> dict[str, Any]:
        states = path.states
        return {
            "hinge": hinge.name, "source": hinge.describe(), "path": heading, "driven": _NAMES[path.driven],
            "theta_rad": states.theta, "tip_m": states.tip, "force_N": states.force, "moment_Nm": states.moment,
            "stiffness_x_y_turn": path.stiffness, "stiffness_z_about_x_about_y": path.out_of_plane,
            "stress_Pa": [s.size for s in path.stress], "stress_leaf": [s.leaf + 1 for s in path.stress],
            "stress_share_of_leaf": [s.share for s in path.stress], "load_factor": path.load_factor,
            "notes": self._notes(hinge, path),
        }  # fmt: skip


_NAMES = {0: "x", Y: "y", TURN: "turn"}


def _columns(path: Path_, strength: float | None) -> tuple[list[str], list[FloatArray | list[str]]]:
    """Header and columns of the table."""
    states, others = path.states, [i for i in range(3) if i != path.driven]
    units = {0: (1e-3, "N/mm"), Y: (1e-3, "N/mm"), TURN: (1.0, "Nm/rad")}
    named: list[tuple[str, FloatArray | list[str]]] = [
        ("deg", np.degrees(states.theta)), ("x mm", 1e3 * states.tip[:, 0]), ("y mm", 1e3 * states.tip[:, 1]),
        ("Fy N", states.force[:, 1]), ("Mz Nmm", 1e3 * states.moment),
    ]  # fmt: skip
    for freedom, values in ((path.driven, path.drive_stiffness), *((i, path.support_stiffness(i)) for i in others)):
        scale, unit = units[freedom]
        named.append((f"k {_NAMES[freedom]} {unit}", scale * values))
    free = path.out_of_plane_free()
    named += [("k z N/mm", 1e-3 * free[:, 0]), ("about x Nm/rad", free[:, 1]), ("about y Nm/rad", free[:, 2])]
    stress = np.array([s.size for s in path.stress]) / 1e6
    loaded = stress > 1e-9 * stress.max()
    where = [f"{s.leaf + 1} {s.share:.2f}" if there else "-" for s, there in zip(path.stress, loaded, strict=True)]
    named += [("MPa", stress), ("leaf at", where)]
    if strength is not None:
        named.append(("used %", 100 * stress / strength))
    named.append(("buckles at", [f"{f:.4g} x" if math.isfinite(f) else "-" for f in path.load_factor]))
    return [name for name, _ in named], [values for _, values in named]


def _rows(columns: list[FloatArray | list[str]]) -> list[list[object]]:
    shown = [[value if isinstance(value, str) else f"{value:.4g}" if abs(value) > 1e-9 else "0" for value in column]
             for column in columns]  # fmt: skip
    return [list(row) for row in zip(*shown, strict=True)]
