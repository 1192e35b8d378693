"""`tensegym policy export`: a trained policy for a robot's own computer."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tyro

from tensegym.control.observations import make_observation
from tensegym.control.policy import CONTROL_PERIOD, policy_env, policy_folder
from tensegym.control.policy_file import read_policy
from tensegym.control.policy_onnx import write_onnx
from tensegym.design.variation import parse_variation
from tensegym.errors import InputError
from tensegym.report import Report, table
from tensegym.robot.robot import TensegrityRobot
from tensegym.tasks.policy_trials import policy_setup

COMMANDS: dict[str, tuple[str, str]] = {
    "export": ("tensegym.cli.policy:Export", "one ONNX file: observation in, action out"),
}


@dataclass(frozen=True)
class Export:
    """Write a policy as one ONNX file, its running statistics inside. Its metadata say what it sees, entry by entry,
    how often it is asked, and to which spool angles its actions lead. docs/training.md runs one in 30 lines."""

    name: tyro.conf.Positional[str]
    """A shipped policy, or a run's folder."""
    out: Path = Path("policy.onnx")
    """File to write."""

    def run(self) -> Report:
        if self.out.exists():
            raise InputError(f"{self.out} is there already; take another --out, or remove it")
        if not self.out.parent.is_dir():
            raise FileNotFoundError(f"no folder {self.out.parent} to write {self.out.name} in")
        saved = read_policy(policy_folder(self.name))
        about = facts(self.name)
        write_onnx(saved, about, self.out)
        rows = [[part["name"], f"{part['rows']} x {part['width']}", f"{part['scale']:.4g} {part['unit']}".rstrip()]
                for part in about["observation"]]  # fmt: skip
        text = table(["observation", "entries", "an entry of 1 is"], rows)
        return Report(f"{self.out}\n\n{text}", {"out": str(self.out), **about})


def facts(name: str) -> dict[str, Any]:
    """What the one who runs a policy on a robot has to know."""
    env, setup = policy_env(name), policy_setup(name)
    with TensegrityRobot(setup.design, dt=setup.task.dt) as robot:
        vary = parse_variation(env["vary"], setup.design) if env.get("vary") else None
        observation = make_observation(env.get("observation", "full"), robot, vary)
        spool = robot.command_limit.tolist()
    parts = [{"name": part.name, "rows": part.rows, "width": part.width, "scale": part.scale, "unit": part.unit}
             for part in observation.parts]  # fmt: skip
    return {
        "policy": name,
        "control_period_s": env.get("control_period", CONTROL_PERIOD),
        "observation": parts,
        "frame": "x along the wanted direction, z up, from the centre of mass on the ground",
        "action": "a drive's spool angle: -1 is 0 rad, 1 is its entry of spool_angles_rad",
        "spool_angles_rad": spool,
    }
