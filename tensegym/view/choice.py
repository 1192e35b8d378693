"""Choice: what a viewer is to show, as its command and its page ask for it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from tensegym.control.policy import shipped_names
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import as_design
from tensegym.design.parameters import Payload, RodFlexure
from tensegym.structure.faces import face_by_nodes, hull_faces
from tensegym.tasks.motions import load_task
from tensegym.tasks.policy_trials import policy_setup
from tensegym.tasks.trials import Setup

SLIDERS = "sliders"
_KINDS = ("walker", "planner", "random")  # of controllers that need no file


@dataclass(frozen=True)
class Choice:
    """A robot, what it is to do, and what drives it; plain data. Fields that are None are the policy's or the task's
    own."""

    driver: str = SLIDERS
    """The sliders, a shipped policy or a run's folder, or a kind of controller: walker, planner, random."""
    design: str | None = None
    """A preset or a TOML file."""
    task: str | None = None
    """A motion or a TOML file."""
    engine: str | None = None
    payload: bool | None = None
    """With one, or without."""
    flexible: bool | None = None
    """With flexures in its passive rods, or with none."""
    face: str = ""
    """It starts on, by its nodes as in 3-5-12; the first by default."""

    def setup(self) -> Setup:
        """The robot, its task, and the table of its controller, empty for the sliders.

        Raises: as `policy_setup`, `load_task` and `as_design`.
        """
        task = load_task(self.task) if self.task else None
        if self.driver == SLIDERS or self.driver in _KINDS:
            task = (task or load_task("roll")).changed(engine=self.engine)
            controller = {} if self.driver == SLIDERS else {"kind": self.driver}
            setup = Setup(self.driver, task, controller, task.equipped(RobotDesign()))
        else:
            setup = policy_setup(self.driver, task=task, engine=self.engine)
        design = setup.task.equipped(as_design(self.design)) if self.design else setup.design
        return replace(setup, design=self._fitted(design))

    def _fitted(self, design: RobotDesign) -> RobotDesign:
        """The design with, or without, payload and flexures."""
        if self.payload is not None:
            design = design.with_(payload=(design.payload or Payload()) if self.payload else None)
        if self.flexible is not None:
            design = design.with_(flexure=(design.flexure or RodFlexure()) if self.flexible else None)
        return design

    def face_of(self, design: RobotDesign) -> int:
        """Index of the face to start on. Raises StructureError where there is no such face."""
        return face_by_nodes(hull_faces(design.standing), self.face) if self.face else 0


def drivers() -> list[str]:
    """What may drive a robot, for a list to pick from."""
    return [SLIDERS, *shipped_names(), *_KINDS]
