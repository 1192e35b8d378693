"""docs/flexure_leg.png and flexure_gripper.png: the two example robots from the side, with their leaf springs.

    python -m docs.flexure_robots
"""

from __future__ import annotations

import warnings
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.bullet import packaged_urdf
from tensegym.flexible import FlexibleRobot, Load, load_robot
from tensegym.plotting import COLOURS, new_figure, save

HERE = Path(__file__).parent
TINTS = {"body": "#b5533c", "finger": "#b5533c", "bone": "0.35", "palm": "0.35", "sole": "black"}


def numbers(element: ET.Element | None, name: str) -> np.ndarray:
    text = "0 0 0" if element is None else element.get(name, "0 0 0")
    return np.array(text.split(), dtype=float)


def draw_links(axis: Any, robot: FlexibleRobot, urdf: ET.Element) -> dict[str, np.ndarray]:
    """Boxes, cylinders and balls of every link, seen along y, [mm] on the axes; returns each link's corners (k, 3)."""
    corners = dict[str, np.ndarray]()
    for link in urdf.iter("link"):
        place, turn = robot.link_pose(link.get("name", ""))
        for visual in link.iter("visual"):
            origin, shape = visual.find("origin"), visual.find("geometry")[0]  # type: ignore[index]
            tilt = numbers(origin, "rpy")[1]
            own = np.array([[np.cos(tilt), 0, np.sin(tilt)], [0, 1, 0], [-np.sin(tilt), 0, np.cos(tilt)]])
            middle = place + turn @ numbers(origin, "xyz")
            if shape.tag == "sphere":
                half = np.full(2, float(shape.get("radius", 0)))
            elif shape.tag == "box":
                half = numbers(shape, "size")[[0, 2]] / 2
            else:
                half = np.array([float(shape.get("radius", 0)), float(shape.get("length", 0)) / 2])
            angles = np.linspace(0, 2 * np.pi, 40)
            ring = np.column_stack([np.cos(angles), np.sin(angles)])
            outline = ring if shape.tag == "sphere" else np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
            points = np.zeros((len(outline), 3))
            points[:, [0, 2]] = outline * half
            seen = 1e3 * (middle + points @ (turn @ own).T)
            name = link.get("name", "")
            corners[name] = np.concatenate([corners.get(name, np.zeros((0, 3))), seen])
            name = visual.find("material").get("name", "")  # type: ignore[union-attr]
            axis.fill(seen[:, 0], seen[:, 2], color=TINTS[name], lw=0, alpha=0.9)
    return corners


def draw_leaves(
    axis: Any, robot: FlexibleRobot, urdf: ET.Element, along: np.ndarray, corners: dict[str, np.ndarray]
) -> None:
    """Every leaf, clamped in both links, as the cubic that a beam under end loads alone bends to."""
    for joint in urdf.iter("joint"):
        flexure = robot.flexures.get(joint.get("name", ""))
        if flexure is None:
            continue
        parent, child = (joint.find(tag).get("link", "") for tag in ("parent", "child"))  # type: ignore[union-attr]
        length = flexure.spring.length
        (place, turn), (tip, turned) = robot.link_pose(parent), robot.link_pose(child)
        start = place + turn @ (numbers(joint.find("origin"), "xyz") - flexure.centre * length * along)
        end = tip + turned @ ((1 - flexure.centre) * length * along)
        s = np.linspace(0, 1, 30)[:, None]
        curve = ((2 * s**3 - 3 * s**2 + 1) * start + (s**3 - 2 * s**2 + s) * length * (turn @ along)
                 + (3 * s**2 - 2 * s**3) * end + (s**3 - s**2) * length * (turned @ along))  # fmt: skip
        for link, point in ((parent, 1e3 * start), (child, 1e3 * end)):  # what holds it is not in the URDF
            near = corners[link][np.linalg.norm((corners[link] - point)[:, [0, 2]], axis=1).argmin()]
            axis.plot([near[0], point[0]], [near[2], point[2]], color="0.35", lw=2.5)
        new = "leaf spring" not in axis.get_legend_handles_labels()[1]
        axis.plot(1e3 * curve[:, 0], 1e3 * curve[:, 2], color=COLOURS[0], lw=2.5, solid_capstyle="butt",
                  label="leaf spring" if new else None)  # fmt: skip


def panel(axis: Any, robot: FlexibleRobot, along: list[float], title: str) -> None:
    urdf = ET.parse(robot.urdf.path).getroot()
    draw_leaves(axis, robot, urdf, np.array(along), draw_links(axis, robot, urdf))
    axis.set(xlabel="x [mm]", title=title, aspect="equal")


def leg() -> None:
    figure, axes = new_figure(1, 3, size=(9, 4.6), sharey=True)
    with load_robot(packaged_urdf("flexure_leg.toml"), fixed_base=True, ground=True, dt=1e-3) as robot:
        robot.place({"rail": 0.243})
        deepest = np.inf
        for axis, (title, seconds) in zip(axes, (("before", 0.0), ("deepest", None), ("at rest", 1.0)), strict=True):
            if seconds is None:
                while robot.positions[robot.joints["rail"]] < deepest:
                    deepest = robot.positions[robot.joints["rail"]]
                    robot.step()
            else:
                robot.step(round(seconds / robot.dt))
            panel(axis, robot, [1.0, 0.0, 0.0], f"{title}, t = {robot.time:.3f} s")
            axis.axhline(0, color="0.5", lw=2)
            axis.set_ylim(-10, 290)
    axes[0].set_ylabel("z [mm]")
    axes[0].legend(loc="upper right", fontsize="small")
    save(figure, HERE / "flexure_leg.png")


def gripper() -> None:
    figure, axes = new_figure(1, 3, size=(9, 3.6), sharey=True)
    with load_robot(packaged_urdf("flexure_gripper.toml"), fixed_base=True, gravity=(0, 0, 0)) as robot:
        for axis, force in zip(axes, (0.0, 0.2, -0.2), strict=True):
            robot.loads = [Load("left_finger", (-force, 0, 0), (0.0, 0.0, 0.07)),
                           Load("right_finger", (force, 0, 0), (0.0, 0.0, 0.07))]  # fmt: skip
            robot.step(4000)
            title = "no load" if not force else f"{abs(force):g} N {'outward' if force > 0 else 'inward'} on each"
            panel(axis, robot, [0.0, 0.0, 1.0], title)
    axes[0].set_ylabel("z [mm]")
    axes[0].legend(loc="upper center", fontsize="small")
    save(figure, HERE / "flexure_gripper.png")


if __name__ == "__main__":
    warnings.filterwarnings("ignore", "flexure .* left its fitted domain")
    leg()
    gripper()
