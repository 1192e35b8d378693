"""Figures of the validation page, one style for all: blue PyBullet, orange MuJoCo, black what is exact."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.plotting import COLOURS, new_figure, save, thin_legend
from tensegym.robot.engines import TITLES

ENGINE_COLOURS = dict(zip(TITLES, COLOURS, strict=False))
EXACT = "black"
Curves = dict[str, dict[str, Any]]
"""By engine, what a problem's figure is drawn from."""


def draw_all(results: dict[str, dict[str, Any]], folder: Path) -> dict[str, Path]:
    """Draw every figure whose problem was measured; the files by problem."""
    folder.mkdir(parents=True, exist_ok=True)
    drawn = {}
    for name, draw in DRAWN.items():
        curves = {part["engine"]: part["curves"] for part in results.values() if part["problem"] == name}
        if curves:
            figure = draw(curves)
            drawn[name] = folder / f"{name}.png"
            save(figure, drawn[name], dpi=100)
    return drawn


def _axes(columns: int, width: float = 5.2) -> tuple[Any, list[Any]]:
    figure, axes = new_figure(1, columns, size=(width * columns, 3.6), squeeze=False)
    return figure, list(axes[0])


def _label(axes: Any, x: str, y: str, title: str = "") -> None:
    axes.set(xlabel=x, ylabel=y, title=title)
    count = len(axes.get_legend_handles_labels()[0])
    if count > 4 and len(axes.figure.axes) == 1:  # beside the curves, which leave no room for so many
        axes.figure.set_figwidth(axes.figure.get_figwidth() + 2.6)
        axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), fontsize="small", frameon=False)
    elif count:
        thin_legend(axes)


MARKS = ("o", "s", "^", "d", "v", "x")
DASHES = ("-", "--", ":", "-.")


def _against_step(curves: Curves, y: str) -> Any:
    """Errors of two cases or more against the time step, a slope of its own to compare with."""
    figure, (axes,) = _axes(1, 6.4)
    for engine, data in curves.items():
        steps = 1e3 * np.array(data["time step, s"])
        (cases,) = [value for value in data.values() if isinstance(value, dict)]
        for mark, dash, (case, errors) in zip(MARKS, DASHES, cases.items(), strict=False):
            filled = {} if engine == "pybullet" else {"markerfacecolor": "none", "markersize": 9}
            axes.loglog(steps, errors, mark + dash, color=ENGINE_COLOURS[engine], label=f"{TITLES[engine]}, {case}",
                        **filled)  # fmt: skip
    axes.set_xticks(steps, [f"{step:g}" for step in steps], minor=False)
    axes.minorticks_off()
    _label(axes, "time step, ms", y)
    return figure


def _bowling(curves: Curves) -> Any:
    figure, (axes,) = _axes(1)
    for engine, data in curves.items():
        axes.plot(data["time, s"], data["measured, m/s"], "o", color=ENGINE_COLOURS[engine], label=TITLES[engine],
                  markersize=3 if engine == "pybullet" else 6, markerfacecolor="none")  # fmt: skip
    axes.plot(data["time, s"], data["exact, m/s"], color=EXACT, linewidth=1, label="exact")
    _label(axes, "time, s", "speed of the point that touches, m/s")
    return figure


def _loop(curves: Curves) -> Any:
    figure, (axes,) = _axes(1)
    (data,) = curves.values()
    for colour, (case, change) in zip(COLOURS, data["change of energy, J"].items(), strict=False):
        axes.plot(data["time, s"], change, color=colour, label=case)
    _label(axes, "time, s", "change of energy, J")
    return figure


def _elastica(curves: Curves) -> Any:
    figure, (axes,) = _axes(1)
    (data,) = curves.values()
    exact, found = np.array(data["exact"]), np.array(data["measured"])
    for i, name in enumerate(("x / L", "deflection / L", "slope, rad")):
        axes.plot(data["P L^2/EI"], exact[:, i], color=COLOURS[i], label=f"{name}, exact")
        axes.plot(data["P L^2/EI"], found[:, i], MARKS[i], color=COLOURS[i], label=f"{name}, finite elements")
    _label(axes, "P L²/EI", "of the tip: x / L, deflection / L, slope in rad")
    return figure


def _creep(curves: Curves) -> Any:
    figure, panels = _axes(len(curves))
    for axes, (engine, data) in zip(panels, curves.items(), strict=True):
        for i, (case, way) in enumerate(data["way, mm"].items()):
            axes.plot(data["time, s"], way, DASHES[i % 2], color=COLOURS[i // 2], label=case)
        _label(axes, "time, s", "way of the centre of mass, mm", TITLES[engine])
        axes.set_ylim(0, 1.05 * max(max(max(w) for w in data["way, mm"].values()) for data in curves.values()))
    return figure


def _contacts(curves: Curves) -> Any:
    figure, panels = _axes(len(curves))
    for axes, (engine, data) in zip(panels, curves.items(), strict=True):
        axes.plot(data["gap, mm"], data["push, N"], ".", color=ENGINE_COLOURS[engine], markersize=3)
        axes.axvline(0, color=EXACT, linewidth=0.8)
        axes.set_xlim(-2, 5)
        _label(axes, "gap, mm (below 0: overlap)", "push along the normal, N", TITLES[engine])
    return figure


def _flight(curves: Curves) -> Any:
    figure, (axes,) = _axes(1, 6.4)
    for engine, data in curves.items():
        for mark, dash, (case, (steps, errors)) in zip(MARKS, DASHES, data.items(), strict=False):
            axes.loglog(steps, errors, mark + dash, color=ENGINE_COLOURS[engine], label=f"{TITLES[engine]}, {case}",
                        markerfacecolor="none", markersize=5 if engine == "pybullet" else 9)  # fmt: skip
    _label(axes, "time step, ms", "RMS error of the nodes after 0.5 s, mm")
    return figure


def _steps(curves: Curves) -> Any:
    figure, (axes,) = _axes(1)
    for shift, (engine, data) in zip((0.98, 1.02), curves.items(), strict=False):
        axes.errorbar(shift * np.array(data["time step, ms"]), data["mean speed, L/s"], data["half of its 95 %"],
                      fmt="o", capsize=4, color=ENGINE_COLOURS[engine], label=TITLES[engine])  # fmt: skip
    axes.set_xscale("log")
    axes.set_xticks(data["time step, ms"], [f"{step:g}" for step in data["time step, ms"]])
    axes.minorticks_off()
    axes.set_ylim(bottom=0)
    _label(axes, "time step, ms", "mean speed of the walker, L/s (95 %)")
    return figure


def _parting(curves: Curves) -> Any:
    figure, panels = _axes(len(curves))
    for axes, (engine, data) in zip(panels, curves.items(), strict=True):
        for apart in data["apart, mm"]:
            axes.semilogy(data["time, s"], np.maximum(apart, 1e-10), color=ENGINE_COLOURS[engine], linewidth=0.8)
        _label(axes, "time, s", "RMS distance of the nodes, mm", TITLES[engine])
    return figure


def _audit(curves: Curves) -> Any:
    figure, panels = _axes(2)
    for engine, data in curves.items():
        excess = 100 * np.array(data["excess"])
        panels[0].plot(100 * np.arange(1, len(excess) + 1) / len(excess), excess, color=ENGINE_COLOURS[engine],
                       label=TITLES[engine])  # fmt: skip
    panels[0].axhline(1, color=EXACT, linewidth=0.8, label="allowed")
    _label(panels[0], "part of the episodes, %", "largest excess of energy, %")
    engine, data = next(iter(curves.items()))
    times = np.array(data["time, s"]) - data["time, s"][0]
    panels[1].plot(times, data["allowed, J"], color=EXACT, label="start and work of the drives")
    panels[1].plot(times, data["energy, J"], color=ENGINE_COLOURS[engine], label="energy")
    _label(panels[1], "time, s", "energy, J", f"{TITLES[engine]}, the worst: seed {data['worst seed']}")
    return figure


DRAWN: dict[str, Callable[[Curves], Any]] = {
    "kane": lambda curves: _against_step(curves, "axis off after 2 s, rad"),
    "boxes": lambda curves: _against_step(curves, "drift of angular momentum in 10 s"),
    "bowling": _bowling, "four_bars": _loop, "bricard": _loop, "elastica": _elastica, "creep": _creep,
    "contacts": _contacts, "flight": _flight, "steps": _steps, "parting": _parting, "audit": _audit,
}  # fmt: skip
