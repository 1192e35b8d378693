"""`tensegym export`: a design as files of other simulators."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import tyro
from scipy.spatial.transform import Rotation

from tensegym.design.design import RobotDesign
from tensegym.design.design_file import as_design, save_design
from tensegym.design.urdf_writer import urdf_files
from tensegym.errors import InputError
from tensegym.exchange import matrix_files, ntrt_text
from tensegym.files import replace_path, write_text
from tensegym.mujoco.robot_mjcf import robot_mjcf
from tensegym.physics.robot_arrays import robot_model
from tensegym.report import Report, table
from tensegym.robot.placement import placed
from tensegym.structure.faces import face_by_nodes, hull_faces, resting_rotation

from .standing import tell_unless_standing

FORMATS = ("mjcf", "urdf", "ntrt", "matrices")


@dataclass(frozen=True)
class Export:
    """Write a design for another simulator, with design.toml to come back by.

    mjcf: robot.xml, the whole robot standing on a face, its cables as tendons that only pull, its winches as actuators
    whose control is the length wound in [m]. urdf: a file for every kind of rod, without cables, which URDF has not.
    ntrt: model.yaml; matrices: nodes.csv, rods.csv, cables.csv; both without drives, payload and flexures.
    """

    design: Annotated[str, tyro.conf.Positional] = "six_rod"
    """A preset (six_rod, six_rod_flexible, paper) or a TOML file."""
    to: str = "mjcf"
    """Format: mjcf, urdf, ntrt, matrices."""
    out: Path = Path("export")
    """Folder to write; must not be there yet."""
    face: str = ""
    """Face to stand on, by its nodes, such as 3-5-12; default: the first one. Of mjcf."""
    units: str = "m"
    """Unit of length in ntrt and matrices: m, dm, cm, mm, in."""

    def run(self) -> Report:
        if self.to not in FORMATS:
            raise InputError(f"to = {self.to!r} is not one of {', '.join(FORMATS)}")
        design = as_design(self.design)
        if self.out.exists() or self.out.is_symlink():
            raise InputError(f"{self.out} is there already; take another --out, or remove it")
        if not self.out.parent.is_dir():
            raise FileNotFoundError(f"no folder {self.out.parent} to make {self.out.name} in")
        tell_unless_standing(design, "pybullet")
        texts = self._texts(design)
        with replace_path(self.out) as folder:
            folder.mkdir()
            save_design(design, folder / "design.toml")
            for name, text in texts.items():
                write_text(folder / name, text)
        names = [*texts, "design.toml"]
        text = table(["out", "files"], [[str(self.out), " ".join(names)]])
        return Report(text, {"out": str(self.out), "files": names})

    def _texts(self, design: RobotDesign) -> dict[str, str]:
        if self.to == "ntrt":
            return {"model.yaml": ntrt_text(design, self.units)}
        if self.to == "matrices":
            return matrix_files(design, self.units)
        return {"robot.xml": self._mjcf(design)} if self.to == "mjcf" else urdf_files(design)

    def _mjcf(self, design: RobotDesign) -> str:
        faces = hull_faces(design.standing)
        triangle = faces.triangles[face_by_nodes(faces, self.face) if self.face else 0]
        turn = Rotation.from_matrix(resting_rotation(design.standing.nodes, triangle, 0.0))
        return robot_mjcf(design, np.asarray(placed(robot_model(design), turn)))
