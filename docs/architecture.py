"""Draws architecture.png: the shelves with the imports between them, four walks over them, and one action as data.

Run in the repository's root: python -m docs.architecture. The arrows are the imports as the sources have them.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

from tensegym.plotting import COLOURS, new_figure, save
from tests.test_layers import OWN, SHELVES, shelf

HERE = Path(__file__).parent

PLACES = {  # of each shelf: column, row from below, what stands there
    "structure": (0.3, 1.0, "a tensegrity at rest"),
    "structures": (0.1, 1.9, "builders of them"),
    "flexure": (2.4, 1.0, "hinges, FEM, joint models"),
    "design": (1.4, 1.9, "a robot as data"),
    "exchange": (0.1, 2.8, "files of other tools"),
    "physics": (1.4, 2.8, "the compiled substep"),
    "engine": (1.7, 3.7, "what a robot needs of one"),
    "bullet": (1.7, 4.6, "PyBullet"),
    "mujoco": (3.0, 4.6, "MuJoCo"),
    "flexible": (3.0, 5.5, "flexures in any URDF"),
    "robot": (1.2, 5.5, "a design in an engine"),
    "control": (0.4, 6.4, "what moves a robot"),
    "tasks": (1.2, 7.2, "what it is to do"),
    "envs": (0.4, 7.95, "Gymnasium"),
    "train": (0.1, 9.6, "PPO"),
    "search": (1.2, 9.35, "over designs"),
    "compare": (2.9, 8.0, "engines side by side"),
    "validation": (3.0, 6.4, "closed forms"),
    "replay": (1.6, 8.65, "recordings and their page"),
    "view": (2.35, 9.95, "in the browser"),
    "cli": (3.0, 10.7, "commands"),
}
TOOLS = ("errors", "arrays", "files", "compiled", "tables", "report", "plotting", "progress", "processes")
WALKS = {  # the shelves that a walk enters, in order, as docs/architecture.md tells them
    "one action": (COLOURS[0], ("envs", "tasks", "robot", "engine", "physics", "bullet")),
    "one hinge": (COLOURS[2], ("cli", "flexure", "flexible")),
    "one design": (COLOURS[3], ("design", "structure", "physics", "robot")),
    "one trial": (COLOURS[1], ("search", "tasks", "control", "robot")),
}
ACTION = (
    ("action (6), -1 to 1", "envs/rolling.py"),
    ("spool angles (6) [rad]", "tasks/episode.py"),
    ("poses (6, 7) from the engine", "bullet/ or mujoco/"),
    ("lengths, rates of change", "physics/geometry.py"),
    ("tensions", "physics/cable_law.py"),
    ("a force and a moment a body", "engine/leapfrog.py"),
    ("drives wind their cables", "physics/drives.py"),
    ("into the engine, one time step", "bullet/ or mujoco/"),
    ("reading: nodes, centre, energies", "robot/reading.py"),
    ("observation, reward terms, info", "envs/rolling.py"),
)
LOOP = (2, 7)  # first and last row of ACTION that a substep repeats
WIDE, HIGH = 1.0, 0.52


def direct_imports() -> dict[str, set[str]]:
    """Of each shelf the shelves it imports, less those that it reaches by way of another."""
    graph = {name: {shelf(m) for module, names in OWN.items() if shelf(module) == name for m in names} - {name}
             for name in PLACES}  # fmt: skip
    below: dict[str, set[str]] = {}
    for name in (s for s in SHELVES if s in graph):
        below[name] = (graph[name] & graph.keys()).union(*(below[other] for other in graph[name] & graph.keys()))
    return {name: {o for o in graph[name] & graph.keys() if not any(o in below[p] for p in graph[name] & graph.keys())}
            for name in graph}  # fmt: skip


def box(axis: Any, x: float, y: float, title: str, text: str, width: float = WIDE, colour: str = "#f4f4f4") -> None:
    """A box around a title and what stands there, its middle at x, y."""
    axis.add_patch(FancyBboxPatch((x - width / 2, y - HIGH / 2), width, HIGH, boxstyle="round,pad=0,rounding_size=0.08",
                                  facecolor=colour, edgecolor="#555555", lw=1, zorder=3))  # fmt: skip
    axis.text(x, y + 0.08, title, ha="center", va="center", fontsize=11, weight="bold", zorder=4)
    axis.text(x, y - 0.13, text, ha="center", va="center", fontsize=8, zorder=4)


def arrow(axis: Any, start: tuple[float, float], end: tuple[float, float], bend: float = 0.0) -> None:
    """From one place to another, behind the boxes."""
    axis.add_patch(FancyArrowPatch(start, end, arrowstyle="-|>", mutation_scale=11, color="#888888", lw=1,
                                   connectionstyle=f"arc3,rad={bend}", zorder=2))  # fmt: skip


def draw_shelves(axis: Any) -> None:
    for name, below in direct_imports().items():
        x, y, _ = PLACES[name]
        for other in below:
            u, v, _ = PLACES[other]
            shift = max(-0.4, min(0.4, 0.3 * (u - x)))
            arrow(axis, (x + shift, y - HIGH / 2), (u - 0.6 * shift, v + HIGH / 2))
    for name, (x, y, text) in PLACES.items():
        box(axis, x, y, name, text)
    box(axis, 1.55, 0.0, "tools", ", ".join(TOOLS), 4.1, "#e8eef6")
    for row, (title, (colour, shelves)) in enumerate(WALKS.items()):
        for step, name in enumerate(shelves, 1):
            x, y, _ = PLACES[name]
            x, y = x - 0.42 + 0.28 * row, y + HIGH / 2
            axis.plot(x, y, "o", color=colour, markersize=13, zorder=5)
            axis.text(x, y - 0.01, str(step), color="white", ha="center", va="center", fontsize=8, zorder=6)
        axis.plot(-0.42, 11.15 - 0.27 * row, "o", color=colour, markersize=13)
        axis.text(-0.27, 11.15 - 0.27 * row, title, va="center", fontsize=9)
    axis.set(xlim=(-0.6, 3.7), ylim=(-0.4, 11.4), title="Shelves: an arrow is an import, a number is a step of a walk")


def draw_action(axis: Any) -> None:
    top = 9.0
    for row, (what, where) in enumerate(ACTION):
        y = top - row
        box(axis, 0.0, y, what, where, 2.3, "#eaf3ea" if LOOP[0] <= row <= LOOP[1] else "#f4f4f4")
        if row:
            arrow(axis, (0.0, y + 1 - HIGH / 2), (0.0, y + HIGH / 2))
    first, last = top - LOOP[0], top - LOOP[1]
    arrow(axis, (1.15, last), (1.15, first), 0.25)
    axis.text(1.78, (first + last) / 2, "200 substeps", rotation=90, va="center", ha="center", fontsize=9)
    axis.set(xlim=(-1.3, 2.0), ylim=(-0.4, 9.6), title="One action as data")


def main() -> None:
    figure, (shelves, action) = new_figure(1, 2, size=(12, 11.5), width_ratios=(4.3, 2.5))
    draw_shelves(shelves)
    draw_action(action)
    for axis in (shelves, action):
        axis.axis("off")
    save(figure, HERE / "architecture.png")


if __name__ == "__main__":
    main()
