"""`tensegym simulate`: drive-angle commands against time in, the whole motion out, as CSV with units."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np

from tensegym.control.commands_file import read_commands
from tensegym.control.playback import Playback
from tensegym.design.design_file import as_design
from tensegym.errors import DesignError, InputError
from tensegym.files import check_file, replace_file
from tensegym.physics import drives
from tensegym.replay import Recorder, write_replay
from tensegym.replay.replay_file import check_replay
from tensegym.report import Report, table
from tensegym.robot.gait import GaitMeter
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.start_poses import start_at
from tensegym.robot.step_check import LARGEST_TIME_STEP

from .options import Within
from .standing import tell_unless_standing


@dataclass(frozen=True)
class Simulate:
    """Simulate a robot under commanded drive angles and write everything it did as CSV."""

    commands: Path
    """CSV: time_s, then drive_1_rad to drive_6_rad, the commanded spool angles; growing times, linear in between."""
    out: Path
    """CSV to write: nodes, rod quaternions, tensions, drives, energies."""
    design: str = "six_rod"
    """A preset (six_rod, six_rod_flexible, paper) or a TOML file."""
    start: str = ""
    """Start pose: a face by its nodes such as 3-5-12, paper-1 or paper-2; default: the first face."""
    heading: Annotated[float, Within(-1e3, 1e3, "rad")] = 0.0
    """Turn about the vertical [rad]."""
    ground: bool = True
    """--no-ground: free flight without gravity."""
    dt: Annotated[float, Within(1e-6, LARGEST_TIME_STEP, "s")] = 1e-3
    """Physics time step [s]."""
    engine: str = "pybullet"
    """Physics engine: pybullet, or mujoco (extra mujoco)."""
    sample: Annotated[float, Within(1e-6, 10.0, "s")] = 0.01
    """Time between rows of the output [s]."""
    replay: Path | None = None
    """Write the motion as one HTML file too, such as run.html, that any browser plays without a network."""

    def run(self) -> Report:
        design = as_design(self.design)
        check_file(self.out)
        if self.replay is not None:
            check_replay(self.replay)
        times, angles = read_commands(self.commands, len(design.structure.stiff_cables))
        every = round(self.sample / self.dt)
        if every < 1 or not math.isclose(every * self.dt, self.sample, rel_tol=1e-6):
            raise InputError(f"sample = {self.sample:g} s must be a whole number of steps of dt = {self.dt:g} s")
        standing = tell_unless_standing(design, self.engine).as_dict() if self.ground else None
        with TensegrityRobot(design, dt=self.dt, ground=self.ground, engine=self.engine) as robot:
            start_at(robot, self.start or robot.faces.names()[0], self.heading)
            commands = Playback(times, angles, self.dt)
            try:
                commands.begin(robot)
            except DesignError as error:
                raise InputError(f"{self.commands}: {error}") from error
            meter = GaitMeter(robot, np.array([1.0, 0.0]))
            rows, recorder = [_row(robot)], Recorder(f"{design.name} under {self.commands.name}")
            recorder.look(robot)
            for _ in range(round((times[-1] - times[0]) / self.sample)):
                for _ in range(every):
                    robot.command(commands.angles(robot))
                    robot.step()
                meter.update()
                rows.append(_row(robot))
                recorder.look(robot, face=meter.face)
            header = _header(robot)
            gait = meter.metrics()
        with replace_file(self.out) as file:
            writer = csv.writer(file)
            writer.writerow(header)
            writer.writerows([[f"{v:.9g}" for v in row] for row in rows])
        if self.replay is not None:
            write_replay(recorder.recording(), self.replay)
        data = {"out": str(self.out), "rows": len(rows), "columns": len(header), **gait.as_dict(),
                "standing": standing, "fault": meter.fault}  # fmt: skip
        text = table(["out", "rows", "columns", "path m", "tips", "slip share", "energy J", "audit excess"],
                     [[str(self.out), len(rows), len(header), gait.path, gait.tips, gait.slip_share, gait.energy,
                       gait.audit_excess]])  # fmt: skip
        return Report(f"{text}\n{meter.fault}" if meter.fault else text, data)


def _header(robot: TensegrityRobot) -> list[str]:
    structure = robot.design.standing
    names = ["time_s"]
    names += [f"node_{n + 1}_{axis}_m" for n in range(len(structure.nodes)) for axis in "xyz"]
    names += [f"rod_{r + 1}_q{axis}" for r in range(len(structure.rods)) for axis in "xyzw"]
    names += [f"tension_{a + 1}_{b + 1}_N" for a, b in structure.cables.tolist()]
    names += [f"stiff_tension_{a + 1}_{b + 1}_N" for a, b in structure.stiff_cables.tolist()]
    if robot.design.payload:
        names += [f"payload_tension_{r + 1}_N" for r in range(len(structure.rods))]
    names += [f"flexure_{r + 1}_{what}" for what in ("rad", "Nm") for r in robot.design.flexible_rods.tolist()]
    for d in range(len(robot.drives)):
        names += [f"drive_{d + 1}_{what}" for what in
                  ("command_rad", "angle_rad", "current_A", "load_torque_Nm", "cable_length_m")]  # fmt: skip
    return [*names, "kinetic_J", "gravity_J", "elastic_J", "drive_work_J", "electrical_energy_J"]


def _row(robot: TensegrityRobot) -> list[float]:
    state, first = robot.drives, robot.model.first_driven
    values = [robot.time, *robot.node_positions_in_world().ravel()]
    values += robot.poses_in_world[: len(robot.design.standing.rods), 3:].ravel().tolist()
    values += [*robot.tensions.tolist(), *robot.flexure_angles.tolist(), *robot.flexure_moments.tolist()]
    for d, (row, angle) in enumerate(zip(state, robot.drive_angles, strict=True)):
        values += [row[drives.COMMAND], angle, row[drives.CURRENT], row[drives.LOAD_TORQUE],
                   robot.natural_lengths[first + d]]  # fmt: skip
    energies, totals = robot.energies(), robot.totals()
    values += [energies.kinetic, energies.gravity, energies.elastic, totals.drive_work, totals.electrical_energy]
    return values
