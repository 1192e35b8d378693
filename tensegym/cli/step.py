"""`tensegym step`: one step of the robot, from face to face, as a storyboard and a figure of its drives."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from tensegym.control.made_for import MadeFor
from tensegym.control.tipping import Pull, Tip, subsets, tip_from, tip_table
from tensegym.control.walker import save_table
from tensegym.design.design_file import as_design
from tensegym.errors import InputError, SimulationError
from tensegym.plotting import require_matplotlib
from tensegym.progress import progress_bar
from tensegym.replay.replay_file import check_replay, write_replay
from tensegym.replay.step_figure import PERIOD, draw_drives, draw_storyboard, record_step
from tensegym.report import Report, table
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.standing import Verdict, standing_verdict
from tensegym.robot.step_check import LARGEST_TIME_STEP, LEAST_TIME_STEP
from tensegym.structure.faces import face_by_nodes

from .options import Within


@dataclass(frozen=True)
class Step:
    """One step: the drives pull and release, the robot tips onto the next face.

    Writes storyboard.png and drives.png.
    """

    face: str = ""
    """Face to start on, by its nodes, such as 3-5-12; default: the first one that the drives tip."""
    drives: tuple[Annotated[int, Within(1, 1000)], ...] = ()
    """Drives that pull, counted from 1; default: the first choice of one to three that tips."""
    depth: Annotated[float, Within(0.0, 1.0)] = 0.3
    """Part of the stiff cables' rest length that is wound in."""
    all_faces: bool = False
    """Instead: try every choice of one to three drives from every face, at --depth and at the design's deepest pull;
    writes tips.json, the walker's table."""
    design: str = "six_rod"
    """A preset (six_rod, six_rod_flexible, paper) or a TOML file."""
    out: Path = Path("step")
    """Folder to write in."""
    replay: Path | None = None
    """Write the step as one HTML file too, such as run.html, that any browser plays without a network."""
    dt: Annotated[float, Within(LEAST_TIME_STEP, LARGEST_TIME_STEP, "s")] = 2e-3
    """Physics time step [s]."""
    engine: str = "pybullet"
    """Physics engine: pybullet, or mujoco (extra mujoco)."""

    def run(self) -> Report:
        design = as_design(self.design)
        limit = design.deepest_pull
        if not 0 < self.depth <= limit:
            raise InputError(f"depth = {self.depth!r} is outside (0, {limit:g}], the design's max_pull")
        if abs(PERIOD / self.dt - round(PERIOD / self.dt)) > 1e-6:
            raise InputError(f"dt = {self.dt!r} s must divide {PERIOD} s")
        if self.out.exists() and not self.out.is_dir():
            raise InputError(f"--out {self.out} is a file; give a folder")
        if self.replay is not None:
            check_replay(self.replay, self.out)
        require_matplotlib()
        verdict = standing_verdict(design, self.engine)
        if verdict.falls_everywhere:
            raise SimulationError(f"{design.name} {verdict.text}".replace("\n", "; "))
        with TensegrityRobot(design, dt=self.dt, engine=self.engine) as robot:
            count = len(robot.drives)
            if not all(1 <= d <= count for d in self.drives) or len(set(self.drives)) < len(self.drives):
                raise InputError(f"drives = {self.drives} must be different numbers from 1 to {count}")
            faces = [face_by_nodes(robot.faces, self.face)] if self.face else range(len(robot.faces.triangles))
            if self.all_faces:
                return self._table(robot, verdict)
            tip = self._find(robot, faces)
            self.out.mkdir(parents=True, exist_ok=True)
            record = record_step(robot, tip)
        draw_storyboard(record, self.out / "storyboard.png")
        draw_drives(record, self.out / "drives.png")
        if self.replay is not None:
            write_replay(record, self.replay)
        names = robot.faces.names()
        pulled = ", ".join(str(d + 1) for d in tip.pull.drives)
        travel = float(np.hypot(*tip.travel))
        data = {"from_face": names[tip.from_face], "to_face": names[tip.to_face], "tipped": tip.tipped,
                "drives": [d + 1 for d in tip.pull.drives], "depth": tip.pull.depth, "travel_m": travel,
                "peak_tension_N": tip.peak_tension, "out": str(self.out), "standing": verdict.as_dict()}  # fmt: skip
        row = [data["from_face"], data["to_face"], pulled, tip.pull.depth, travel, tip.peak_tension]
        text = table(["from face", "to face", "drives", "depth", "travel m", "peak tension N"], [row])
        text += f"\n{design.name} {verdict.text}"
        if not tip.tipped:
            text += "\nThe robot did not tip; try other --drives or a larger --depth."
        return Report(text, data, passed=tip.tipped)

    def _find(self, robot: TensegrityRobot, faces: Any) -> Tip:
        choices = [tuple(d - 1 for d in self.drives)] if self.drives else list(subsets(len(robot.drives)))
        for face in faces:
            for chosen in choices:
                tip = tip_from(robot, face, Pull(chosen, self.depth))
                if tip.tipped or (self.face and self.drives):
                    return tip
        what = f"pull of drives {', '.join(map(str, self.drives))}" if self.drives else "choice of one to three drives"
        where = self.face or "any face"
        raise SimulationError(f"no {what} tips the robot from {where} at depth {self.depth:g}")

    def _table(self, robot: TensegrityRobot, verdict: Verdict) -> Report:
        with progress_bar(desc="pulls", unit="pull") as bar:
            def progress(done: int, total: int) -> None:
                bar.total = total
                bar.update(done - bar.n)

            tips = tip_table(robot, (self.depth, robot.design.deepest_pull), progress=progress)
        self.out.mkdir(parents=True, exist_ok=True)
        save_table(tips, self.out / "tips.json", MadeFor.like(robot))
        names = robot.faces.names()
        rows = []
        for face, name in enumerate(names):
            here = [t for t in tips if t.from_face == face]
            moved = [t for t in here if t.tipped]
            targets = sorted({names[t.to_face] for t in moved})
            kind = "closed" if robot.faces.closed[face] else "open"
            rows.append([name, kind, f"{len(moved)} of {len(here)}", " ".join(targets)])
        total = sum(t.tipped for t in tips)
        text = table(["face", "kind", "pulls that tip", "onto"], rows) + f"\n{total} of {len(tips)} pulls tip the robot"
        text += f"\n{robot.design.name} {verdict.text}"
        data = {"out": str(self.out / "tips.json"), "pulls": len(tips), "tipped": total,
                "peak_tension_N": max(t.peak_tension for t in tips), "standing": verdict.as_dict()}  # fmt: skip
        return Report(text, data)
