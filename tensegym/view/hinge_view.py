"""HingeView: a hinge under a force and a moment from sliders, by finite elements and by the models fitted to it."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure import fem
from tensegym.flexure.fem.sampling import moment_at
from tensegym.flexure.hinge import Hinge
from tensegym.flexure.models.joint import MODELS, Joint
from tensegym.flexure.models.load_solver import Answer, solve_model

from .hinge_scene import HingeScene, rgb
from .page import Page

FEM = "finite elements"
_PERIOD = 1 / 30  # s between two looks at the sliders
_CURVE = 41  # angles of the plot


class HingeView:
    """A hinge in a page.

    Args:
        page: to draw into.
        hinge: what is bent.
        joint: the models fitted to it; the sliders end where it was fitted.
        elements: of a leaf as long as the hinge.

    Raises:
        FlexureError: no pure moment holds the hinge at its largest rotation.
    """

    def __init__(self, page: Page, hinge: Hinge, joint: Joint, elements: int = fem.ELEMENTS) -> None:
        self.page, self.hinge, self.joint, self.elements = page, hinge, joint, elements
        self._ended, self._returned = threading.Event(), threading.Event()
        self._names = {FEM: FEM, **{name: MODELS[name] for name in joint.models}}
        self.scene = HingeScene(page, hinge, elements, tuple(self._names))
        page.gui.main_panel.dock_right()
        page.gui.main_panel.set_width(460)
        page.gui.add_markdown(hinge.describe())
        most = 1e3 * moment_at(hinge, joint.box.max_angle, elements)
        (fx, FX), (fy, FY) = joint.box.ends.tolist()
        self.sliders = [_slider(page, "Fx [N]", fx, FX), _slider(page, "Fy [N]", fy, FY),
                        _slider(page, "moment [N mm]", -most, most)]  # fmt: skip
        zero = page.gui.add_button("no load")
        zero.on_click(lambda _: self._unload())
        self._table = page.gui.add_markdown("")
        self._plot = _plot(page, self._names)
        self.answers: dict[str, Answer] = {}
        self._shown: FloatArray | None = None
        self.turn()

    def _unload(self) -> None:
        for slider in self.sliders:
            slider.value = 0.0

    def load(self) -> FloatArray:
        """(3,) force x, y [N] and moment [N m] of the sliders."""
        return np.array([slider.value for slider in self.sliders]) * [1.0, 1.0, 1e-3]

    def turn(self) -> None:
        """Bend the hinge where a slider has moved."""
        load = self.load()
        if self._shown is not None and np.array_equal(load, self._shown):
            return
        self._shown = load
        solution = fem.apply_wrench(self.hinge, load, elements=self.elements, keep_nodes=True)
        (x, y), energy = solution.tip[0].tolist(), float(solution.energy[0])
        found = Answer(float(solution.theta[0]), x, y, energy, solution.reason(0))
        self.answers = {FEM: found} | {
            name: solve_model(model, self.joint.box, load[None])[0] for name, model in self.joint.models.items()
        }
        with self.page.atomic():
            if not found.reason:
                self.scene.draw_leaves(solution.nodes[0])
            self.scene.draw_tips(self.answers)
        self._table.content = self._told()
        self._plot.data = self._curves(load)

    def _told(self) -> str:
        """The table of poses and of what each model misses."""
        exact = self.answers[FEM]
        rows = ["| | angle [deg] | x [mm] | y [mm] | error [deg] | error [mm] |", "|---|---|---|---|---|---|"]
        for number, (name, answer) in enumerate(self.answers.items()):
            title = f'<span style="color:rgb{rgb(number)}">&#9644;</span> {self._names[name]}'
            if answer.reason:
                rows.append(f"| {title} | {answer.reason.replace('|', '/')} | | | | |")
                continue
            cells = [f"{np.degrees(answer.theta):.3f}", f"{1e3 * answer.x:.3f}", f"{1e3 * answer.y:.3f}"]
            turn, way = miss(answer, exact)
            cells += ["", ""] if name == FEM or exact.reason else [f"{np.degrees(turn):.4f}", f"{1e3 * way:.4f}"]
            rows.append(f"| {title} | {' | '.join(cells)} |")
        return "\n".join(rows)

    def _curves(self, load: FloatArray) -> tuple[FloatArray, ...]:
        """Angles [deg], then the moment [N mm] of every model at the load's force, the finite elements' first."""
        angles = np.linspace(-self.joint.box.max_angle, self.joint.box.max_angle, _CURVE)
        exact = fem.rotate(self.hinge, angles, force=load[:2], elements=self.elements)
        rows = [exact.moment]
        for model in self.joint.models.values():
            try:
                rows.append(model.poses(angles, np.broadcast_to(load[:2], (_CURVE, 2))).moment)
            except FlexureError:
                rows.append(np.full(_CURVE, np.nan))
        return (np.degrees(angles), *(1e3 * row for row in rows))

    def run(self) -> None:
        """Until it is interrupted, or told to `end`."""
        try:
            while not self._ended.is_set():
                self.turn()
                time.sleep(_PERIOD)
        finally:
            self._returned.set()

    def end(self) -> None:
        """Let `run`, in whichever thread it is, return."""
        self._ended.set()
        self._returned.wait()


def miss(answer: Answer, exact: Answer) -> tuple[float, float]:
    """How far an answer is from another: angle [rad], place of the tip [m]."""
    return abs(answer.theta - exact.theta), float(np.hypot(answer.x - exact.x, answer.y - exact.y))


def _slider(page: Page, name: str, low: float, high: float) -> Any:
    step = 10.0 ** np.floor(np.log10((high - low) / 100))
    low, high = step * np.ceil(low / step), step * np.floor(high / step)
    return page.gui.add_slider(name, float(low), float(high), float(step), float(np.clip(0.0, low, high)))


def _plot(page: Page, names: dict[str, str]) -> Any:
    lines = [{"label": title, "stroke": f"rgb{rgb(n)}", "width": 2 if n else 3, "points": {"show": False}}
             for n, title in enumerate(names.values())]  # fmt: skip
    return page.gui.add_uplot(
        tuple(np.zeros(2) for _ in range(len(lines) + 1)), ({"label": "angle [deg]"}, *lines),
        title="moment [N mm] over angle [deg] at this force", height=260, scales={"x": {"time": False}},
        axes=({"label": "angle [deg]"}, {}), legend={"show": False},
    )  # fmt: skip
