"""`tensegym flexure track`: pictures of a stand in, angle and tip position out, as the CSV that `fit --data` reads."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import Annotated

import tyro

from tensegym.cli.options import Within
from tensegym.errors import FlexureError, InputError
from tensegym.files import check_file, replace_file
from tensegym.flexure.measured.base_frame import BaseFrame, frame_at_rest
from tensegym.flexure.measured.measured_file import quantity
from tensegym.flexure.measured.photo import draw_overlay, read_grey
from tensegym.flexure.measured.sighting import Sighting, sight
from tensegym.report import Report, table
from tensegym.tables import read_rows

_MM = 1e-3


@dataclass(frozen=True)
class Track:
    """Find the black arm and the black marker on the light ground of each picture; write angle and tip position.

    The marker is a spot fixed to the stand, nearer to the arm's hinge end. Base axes have their origin at the hinge's
    fixed end, x along the undeformed arm: give --rest, or hold the camera level and give the marker's place.
    """

    images: Annotated[tuple[Path, ...], tyro.conf.Positional]
    """Pictures, one state each."""
    arm_length_mm: Annotated[float, Within(0.1, 1e5, "mm")]
    """Length of the painted arm: the scale of every picture."""
    out: Path
    """CSV to write: image, angle_deg, x_mm, y_mm and the loads."""
    loads: Path | None = None
    """CSV with a column image (file names) and the loads they show: force_N, or Fx_N and Fy_N, or torque_Nmm."""
    rest: Path | None = None
    """Picture of the unloaded stand: fixes the base axes, whatever the camera's tilt and the marker's place."""
    hinge_length_mm: Annotated[float, Within(0.1, 1e5, "mm")] = 40.0
    """With --rest: where the tip is at rest, on the x axis."""
    arm_start_mm: Annotated[float, Within(-1e5, 1e5, "mm")] = 0.0
    """How far beyond the hinge's tip the painted arm begins."""
    marker_x_mm: Annotated[float, Within(-1e5, 1e5, "mm")] = 0.0
    """Without --rest: the marker's centre in base axes."""
    marker_y_mm: Annotated[float, Within(-1e5, 1e5, "mm")] = 0.0
    """Without --rest: the marker's centre in base axes."""
    overlay: Path | None = None
    """Folder for a copy of each picture with the arm and the marker that were found drawn on it."""

    def run(self) -> Report:
        if not self.images:
            raise InputError("no pictures given")
        check_file(self.out)
        load_header, loads = read_loads(self.loads, self.images) if self.loads else ([], [[] for _ in self.images])
        frame = self._frame()
        sightings = [sight_file(path) for path in self.images]
        rows: list[list[str | float]] = []
        for path, seen in zip(self.images, sightings, strict=True):
            theta, tip = frame.pose(seen, self.arm_length_mm * _MM, self.arm_start_mm * _MM)
            rows.append([path.name, degrees(theta), float(tip[0]) / _MM, float(tip[1]) / _MM])
        with replace_file(self.out) as file:
            writer = csv.writer(file)
            writer.writerow(["image", "angle_deg", "x_mm", "y_mm", *load_header])
            writer.writerows([[row[0], *(f"{v:z.6f}" for v in row[1:]), *load]
                              for row, load in zip(rows, loads, strict=True)])  # fmt: skip
        if self.overlay is not None:
            self.overlay.mkdir(parents=True, exist_ok=True)
            for k, (path, seen) in enumerate(zip(self.images, sightings, strict=True), 1):
                draw_overlay(read_grey(path), seen, self.overlay / f"{k:03d}-{path.stem}.png")
        return self._report(rows, sightings)

    def _frame(self) -> BaseFrame:
        if self.rest is None:
            return BaseFrame(0.0, (self.marker_x_mm * _MM, self.marker_y_mm * _MM))
        return frame_at_rest(sight_file(self.rest), self.arm_length_mm * _MM, self.hinge_length_mm * _MM,
                             self.arm_start_mm * _MM)  # fmt: skip

    def _report(self, rows: list[list[str | float]], sightings: list[Sighting]) -> Report:
        names = ["image", "angle_deg", "x_mm", "y_mm", "angle_error_deg", "mm_per_px"]
        facts = [[*row, degrees(seen.angle_error), self.arm_length_mm * seen.metres_per_pixel(1.0)]
                 for row, seen in zip(rows, sightings, strict=True)]  # fmt: skip
        text = table(["image", "angle deg", "x mm", "y mm", "angle error deg", "mm a px"], facts)
        text += f"\n{len(rows)} pictures -> {self.out}"
        data = {"out": str(self.out), "pictures": [dict(zip(names, fact, strict=True)) for fact in facts]}
        return Report(text, data)


def sight_file(path: Path) -> Sighting:
    """The arm and marker in a picture file; every refusal names the file."""
    grey = read_grey(path)
    try:
        return sight(grey)
    except FlexureError as error:
        raise FlexureError(f"{path}: {error}") from None


def read_loads(path: Path, images: tuple[Path, ...]) -> tuple[list[str], list[list[str]]]:
    """Header and cells of the load columns of ``path``, one row for each picture, matched by file name.

    Raises InputError for a picture without loads, a name given twice, a missing column or unit.
    """
    header, rows, _ = read_rows(path)
    titles = [title.strip() for title in header]
    if "image" not in titles:
        raise InputError(f"{path}: no column image to tell which picture a load belongs to")
    try:
        known = [quantity(title) for title in titles]
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    keep = [k for k, found in enumerate(known) if found is not None and found[0] not in ("angle", "x", "y")]
    if not keep:
        raise InputError(f"{path}: no load: a column force_N, Fx_N and Fy_N, or torque_Nmm is needed")
    by_name = {row[titles.index("image")].strip(): [row[k].strip() for k in keep] for row in rows}
    if len(by_name) < len(rows):
        raise InputError(f"{path}: a picture is named twice in column image")
    missing = [image.name for image in images if image.name not in by_name]
    if missing:
        raise InputError(f"{path}: no load for picture {missing[0]}")
    return [titles[k] for k in keep], [by_name[image.name] for image in images]
