"""`tensegym view`: a robot, a replay or a study in the browser."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from tensegym.errors import InputError
from tensegym.replay import Recording, read_replay
from tensegym.report import Report

from .options import Within

if TYPE_CHECKING:
    from tensegym.view.page import Page

_LIVE = ("policy", "design", "task", "engine", "start")  # options of a robot that runs


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
    replay: Path | None = None
    """Instead: play a replay, with a slider over its time."""
    study: Path | None = None
    """Instead: play what a design study began with and its best robots, side by side."""
    best: Annotated[int, Within(1, 20)] = 3
    """Robots of a study beside the one it began with."""
    port: Annotated[int, Within(0, 65535)] = 8080
    """To listen on; 0: any that is free."""
    host: str = "127.0.0.1"
    """Address to listen on: this machine alone, unless another one is given. Whoever reaches it may drive the robot."""

    def run(self) -> Report:
        import tensegym.view.page  # noqa: F401  # where there is no viser, nothing is simulated first

        given = [f.name for f in fields(self) if f.name in _LIVE and getattr(self, f.name) != f.default]
        if self.replay is not None and self.study is not None:
            raise InputError("give one of --replay and --study")
        if given and (self.replay or self.study):
            raise InputError(f"--{given[0]} has no effect with a replay or a study, which are over; leave it out")
        if self.replay is not None:
            return self._play([read_replay(self.replay)], [])
        if self.study is not None:
            return self._play_study(self.study)
        return self._run()

    def _run(self) -> Report:
        from tensegym.view.choice import Choice
        from tensegym.view.live import Live

        choice = Choice(self.policy, self.design, self.task, self.engine, face=self.start)
        choice.setup()  # what cannot be shown is refused before anything listens
        with self._page() as page:
            live = Live(page, choice)
            tell(page)
            try:
                live.run()
            finally:
                live.close()
        return Report("", {"url": page.url})

    def _play_study(self, folder: Path) -> Report:
        from tensegym.view.study import study_recordings

        from .design import open_search

        problem, store = open_search(folder)
        return self._play(*study_recordings(problem, store.finished(), self.best))

    def _play(self, recordings: list[Recording], names: list[str]) -> Report:
        from tensegym.view.player import Player

        with self._page() as page:
            player = Player(page, recordings, names)
            tell(page)
            player.run()
        return Report("", {"url": page.url})

    def _page(self) -> Page:
        from tensegym.view.page import Page

        return Page("tensegym", self.host, self.port)


def tell(page: Page) -> None:
    """Say where a page is to be seen."""
    print(f"{page.url} shows it; Ctrl-C ends it", flush=True)
