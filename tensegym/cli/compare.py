"""`tensegym compare`: the engines side by side on one robot."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from tensegym.compare.episodes import episodes
from tensegym.compare.motion import PERIOD, free_flight, on_ground
from tensegym.compare.part import ENGINES, Part
from tensegym.compare.picture import draw
from tensegym.compare.settling import settling
from tensegym.compare.steps import steps
from tensegym.control.commands_file import read_commands
from tensegym.control.playback import Playback
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import as_design
from tensegym.errors import DesignError, InputError
from tensegym.files import VERSION, lock_folder, write_text
from tensegym.plotting import require_matplotlib
from tensegym.report import Report, table, to_json
from tensegym.robot.engines import check_engine
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.step_check import LARGEST_TIME_STEP, LEAST_TIME_STEP
from tensegym.tasks.policy_trials import EPISODE_SECONDS, policy_setup
from tensegym.tasks.trials import check_setup

from .options import Count, Jobs, Within
from .standing import tell_unless_standing


@dataclass(frozen=True)
class Compare:
    """Compare PyBullet and MuJoCo: free flight, the settling height of each face, and what else is asked for.

    Writes compare.json and compare.png. Exits with 1 where the engines differ by more than is expected.
    """

    policy: str | None = None
    """Also episodes of a shipped policy or a run's folder, whose robot is then the one compared."""
    commands: Path | None = None
    """Also nodes against time on the ground under a CSV of commands, as `tensegym simulate` takes it."""
    step: bool = False
    """Also the end face of every pull of the tip table; some minutes."""
    design: str = "six_rod"
    """A preset (six_rod, six_rod_flexible, paper) or a TOML file."""
    episodes: Count = 20
    """Episodes of the policy in each engine."""
    seconds: Annotated[float, Within(1.0, 3600.0, "s")] = EPISODE_SECONDS
    """Length of an episode [s]."""
    depths: tuple[Annotated[float, Within(0.0, 1.0)], ...] = (0.3, 0.45)
    """Depths of the table's pulls, parts of the stiff cables' rest lengths."""
    dt: Annotated[float, Within(LEAST_TIME_STEP, LARGEST_TIME_STEP, "s")] = 2e-3
    """Physics time step [s]; a policy's episodes have their own."""
    jobs: Jobs | None = None
    """Processes; default: one a core."""
    out: Path = Path("compare")
    """Folder to write in."""

    def run(self) -> Report:
        for engine in ENGINES:
            check_engine(engine)
        require_matplotlib()
        if abs(PERIOD / self.dt - round(PERIOD / self.dt)) > 1e-6:
            raise InputError(f"dt = {self.dt!r} s must divide {PERIOD} s")
        design = as_design(self.design)
        if self.policy is not None:
            setup = policy_setup(self.policy, seconds=self.seconds)
            check_setup(setup)
            design = setup.design
        self._check(design)
        with lock_folder(self.out):
            tell_unless_standing(design, "pybullet")
            parts = list(self._parts(design))
            agrees = all(part.agrees for part in parts)
            data = {"design": design.name, "dt": self.dt, "agrees": agrees, "parts": {
                part.title: {"agrees": part.agrees, "verdict": part.verdict, "header": part.header, "rows": part.rows,
                             **part.curves} for part in parts}}  # fmt: skip
            write_text(self.out / "compare.json", to_json({"version": VERSION, **data}, indent=1) + "\n")
            draw(parts, self.out / "compare.png")
        text = "\n\n".join(f"{table(part.header, part.rows)}\n{part.verdict}" for part in parts)
        return Report(text, {"out": str(self.out), **data}, passed=agrees)

    def _check(self, design: RobotDesign) -> None:
        """Raise for what does not fit the robot, before anything is simulated or written."""
        most = design.deepest_pull
        for depth in self.depths:
            if not 0 < depth <= most:
                raise InputError(f"depths: {depth!r} is outside (0, {most:g}], the design's max_pull")
        with TensegrityRobot(design, dt=self.dt) as robot:
            if self.commands is None:
                return
            commands = read_commands(self.commands, len(robot.drives))
            try:
                Playback(*commands, PERIOD).begin(robot)
            except DesignError as error:
                raise InputError(f"{self.commands}: {error}") from error

    def _parts(self, design: RobotDesign) -> Iterator[Part]:
        yield free_flight(design, self.dt)
        yield settling(design, self.dt)
        if self.commands is not None:
            yield on_ground(design, self.dt, *read_commands(self.commands, len(design.structure.stiff_cables)))
        if self.step:
            yield steps(design, self.dt, self.depths, self.jobs or 0)
        if self.policy is not None:
            yield episodes(self.policy, self.episodes, self.seconds, self.jobs or 0)
