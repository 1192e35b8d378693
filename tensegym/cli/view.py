"""`tensegym view`: a robot in the browser, to look at and to drive."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from tensegym.report import Report

from .options import Within


@dataclass(frozen=True)
class View:
    """Serve a page on this machine with the robot in 3-D, its drives on sliders and its plots; Ctrl-C ends it."""

    policy: str = "sliders"
    """What drives it at first: sliders, a shipped policy or a run's folder, walker, planner or random."""
    design: str | None = None
    """A preset (six_rod, six_rod_flexible, paper) or a TOML file, in place of the policy's own robot."""
    task: str | None = None
    """A motion (roll, climb, cross, step, steer, places, path) or a TOML file with a [task] table, in place of the
    policy's own task."""
    engine: str | None = None
    """Physics engine: pybullet, or mujoco (extra mujoco); default: the task's."""
    start: str = ""
    """Face to start on, by its nodes such as 3-5-12; default: the first."""
    port: Annotated[int, Within(0, 65535)] = 8080
    """To listen on; 0: any that is free."""
    host: str = "127.0.0.1"
    """Address to listen on: this machine alone, unless another one is given. Whoever reaches it may drive the robot."""

    def run(self) -> Report:
        from tensegym.view.choice import Choice
        from tensegym.view.live import Live
        from tensegym.view.page import Page

        choice = Choice(self.policy, self.design, self.task, self.engine, face=self.start)
        choice.setup()  # what cannot be shown is refused before anything listens
        with Page("tensegym", self.host, self.port) as page:
            live = Live(page, choice)
            print(f"{page.url} shows it; Ctrl-C ends it", flush=True)
            try:
                live.run()
            finally:
                live.close()
        return Report("", {"url": page.url})
