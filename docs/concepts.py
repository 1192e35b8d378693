"""Draws the pictures of concepts.md: `python -m docs.concepts`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from tensegym import RobotDesign, TensegrityRobot
from tensegym.control.tipping import Pull, tip_from
from tensegym.physics.robot_arrays import explicit_step_limit, robot_model
from tensegym.plotting import COLOURS, new_figure, save, thin_legend
from tensegym.structure.equilibrium import out_of_balance
from tensegym.structure.structure import six_rod

FOLDER = Path(__file__).parent / "concepts"


def draw_spacing() -> None:
    """What 10 N in every cable leaves on a node, against the distance of parallel rods."""
    apart = np.linspace(0.3, 0.7, 81)
    left = [np.linalg.norm(out_of_balance(six_rod(1.0, d), 10.0), axis=1).max() for d in apart]
    figure, axis = new_figure(size=(6, 3))
    axis.plot(apart, left, color=COLOURS[0])
    axis.plot(0.5, 0, "o", color=COLOURS[1])
    axis.annotate("balance", (0.5, 0.1), (0.485, 2.2), ha="center", arrowprops={"arrowstyle": "->"})
    axis.set_xlabel("distance of parallel rods [rod lengths]")
    axis.set_ylabel("force left on a node [N]")
    axis.set_ylim(bottom=-0.3)
    save(figure, FOLDER / "spacing.png")


def draw_tip() -> None:
    """Support triangle and centre of mass from above, at rest and while a pull tips the robot over an edge."""
    figure, axis = new_figure(size=(6, 5))
    with TensegrityRobot(dt=2e-3) as robot:
        limit = robot.design.stiff_cable.max_pull
        tip = next(t for drive in range(6) if (t := tip_from(robot, 0, Pull((drive,), limit))).tipped)
        robot.reset(face=0)
        triangle, nodes = robot.faces.triangles[0], robot.node_positions_in_world()
        corners = nodes[[*triangle, triangle[0]], :2]
        axis.fill(*corners.T, color=COLOURS[5], alpha=0.4, label="triangle it stands on")
        for a, b in robot.design.structure.rods:
            axis.plot(*nodes[[a, b], :2].T, color="0.8", linewidth=4, zorder=0)
        for n in triangle:
            axis.annotate(f"{n + 1}", nodes[n, :2], textcoords="offset points", xytext=(6, 6))
        way = [robot.centre_of_mass_in_world()[:2]]
        for step in range(180):
            robot.command(tip.pull.angles(robot, 0.02 * step))
            robot.step(10)
            way.append(robot.centre_of_mass_in_world()[:2])
    way = np.array(way)
    axis.plot(*way.T, color=COLOURS[1], label="centre of mass: a pull of 2 s, let out in 1.6 s")
    axis.plot(*way[0], "o", color=COLOURS[1])
    axis.set_aspect("equal")
    axis.set_ylim(top=0.47)  # room for the legend above the rods
    axis.set_xlabel("x [m]")
    axis.set_ylabel("y [m]")
    thin_legend(axis, loc="upper left")
    save(figure, FOLDER / "tip.png")


def draw_step() -> None:
    """Up to which time step explicit cable forces are stable, against the stiffness of the wound cables."""
    design, stiffness = RobotDesign(), np.geomspace(1e3, 2e5, 25)
    cables = [replace(design.stiff_cable, stiffness=float(k)) for k in stiffness]
    limits = [explicit_step_limit(robot_model(design.with_(stiff_cable=cable))) for cable in cables]
    here = design.stiff_cable.stiffness
    figure, axis = new_figure(size=(6, 3.2))
    axis.loglog(stiffness, 1e3 * np.array(limits), color=COLOURS[0], label="explicit forces: limit")
    axis.axhline(2, color=COLOURS[1], linestyle="--", label="2 ms, taken with implicit forces")
    axis.plot(here, 1e3 * explicit_step_limit(robot_model(design)), "o", color=COLOURS[0], label="default robot")
    axis.set_xlabel("stiffness of the wound cables [N/m]")
    axis.set_ylabel("time step [ms]")
    axis.set_yticks([0.75, 1, 1.5, 2], ["0.75", "1", "1.5", "2"])
    axis.minorticks_off()
    axis.set_ylim(0.7, 2.2)
    thin_legend(axis)
    save(figure, FOLDER / "step.png")
    print(f"default robot: {1e3 * explicit_step_limit(robot_model(design)):.3g} ms")


if __name__ == "__main__":
    draw_spacing()
    draw_tip()
    draw_step()
