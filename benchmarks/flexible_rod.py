"""A rod with a leaf spring in the middle, free in flight: what a pin with a spring in the leaf's place gets wrong.

    python benchmarks/flexible_rod.py

Two half tubes of 14 g (8/6 mm) with 50 g at their outer ends, 0.7017 m over all, and between them a leaf of steel,
40 x 20 x 1 mm, without mass; the ends are pressed together by dead loads along the rod. The first bending frequency:

    pin      sqrt((2 K - P h) / I), h from the pin to the end, I of one half about its own centre; K at P = 0, or fitted
             at P (rod_pin.py)
    beam     sqrt((EI k cot(k s / 2) - P a) / I), k^2 = P / EI, s the leaf's length, a = h - s / 2: the leaf exactly
    FEM      modes of two rigid halves on the FEM's tangent at P
    PyBullet FlexibleRobot with the leaf's fitted potential, let go from 1 deg, 0.5 ms

and by the FEM and beam formulas the modes that a pin leaves out.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import tempfile
from pathlib import Path

import numpy as np
from scipy.linalg import eigh

from tensegym.flexible import FlexibleRobot, FlexureJoint, Load
from tensegym.flexible.stand import Vibration
from tensegym.flexure import fem
from tensegym.flexure.fem import newton
from tensegym.flexure.fem.assembly import assemble
from tensegym.flexure.fem.buckling import buckling_load
from tensegym.flexure.fem.memory import memory
from tensegym.flexure.hinge import Hinge, Material
from tensegym.flexure.hinge.presets import leaf_spring
from tensegym.flexure.models.joint import Joint
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.flexure.models.rod_pin import rod_pin, rod_states
from tensegym.report import table

LENGTH, TUBE, END = 0.7017, 0.014, 0.05  # m; kg of a half tube, of an end
OUTER, INNER = 0.004, 0.003  # m, radii of the tube
LEAF = leaf_spring(length=0.04, width=0.02, thickness=1e-3, material=Material(210e9, 0.3))
LOADS = (0.0, 10.0, 24.5, 40.0)  # N
ANGLE = np.radians(1.0)
HALF = LENGTH / 2
PART = HALF - LEAF.length / 2
MASS = TUBE + END
CENTRE = (TUBE * (HALF - PART / 2) + END * HALF) / MASS  # m from the rod's middle
INERTIA = TUBE * (PART**2 / 12 + (HALF - PART / 2 - CENTRE) ** 2) + END * (HALF - CENTRE) ** 2
AXIAL = TUBE * (OUTER**2 + INNER**2) / 2  # kg m^2, about the rod's axis

URDF = """<robot name="rod">{links}
  <joint name="leaf" type="continuous"><parent link="left"/><child link="right"/><axis xyz="0 0 1"/></joint>
</robot>"""
LINK = """
  <link name="{name}"><inertial><origin xyz="{centre} 0 0"/><mass value="{mass}"/>
    <inertia ixx="{axial}" iyy="{inertia}" izz="{inertia}" ixy="0" ixz="0" iyz="0"/></inertial></link>"""


def bending(hinge: Hinge) -> float:
    """EI of the leaf [N m^2]."""
    (leaf,) = hinge.leaves
    return hinge.material.effective_modulus * leaf.width * leaf.thickness**3 / 12


def pin_frequency(stiffness: float, load: float) -> float:
    """[Hz]: each half turns about its own centre."""
    return float(np.sqrt((2 * stiffness - load * HALF) / INERTIA) / (2 * np.pi))


def beam_frequency(load: float) -> float:
    """[Hz]: the half leaf's end turns under a moment as a beam-column's."""
    ei = bending(LEAF)
    k = np.sqrt(load / ei)
    stiffness = ei * k / np.tan(k * LEAF.length / 2) if load else 2 * ei / LEAF.length
    return float(np.sqrt((stiffness - load * PART) / INERTIA) / (2 * np.pi))


def fem_frequencies(load: float) -> np.ndarray:
    """(3,) elastic modes in the plane [Hz]: bending, shear, stretch. Coordinates: x, y, turn of the leaf's two ends."""
    mesh = fem.mesh_of(LEAF)
    state, ask = memory(mesh), np.zeros(8)
    ask[newton.FX], ask[newton.ARM] = -load, PART
    assert newton.newton(mesh, state, newton.LOAD, ask)[0]
    assemble(mesh, state)
    apart = state.poses[-1, 0]
    # the tip's pose in base axes over both ends' motion, and the curvature of its x, which carries -load
    relative = np.array([[-1, 0, 0, 1, 0, 0], [0, -1, -apart, 0, 1, 0], [0, 0, -1, 0, 0, 1.0]])
    stiffness = relative.T @ state.matrix @ relative
    stiffness[2, 2] += load * apart - load * PART
    stiffness[5, 5] -= load * PART
    for i, j, sign in ((2, 4, -1), (2, 1, 1)):
        stiffness[i, j] += sign * load
        stiffness[j, i] += sign * load
    mass, arm = np.zeros((6, 6)), CENTRE - LEAF.length / 2
    for first, d in ((0, -arm), (3, arm)):
        mass[first : first + 3, first : first + 3] = [[MASS, 0, 0], [0, MASS, MASS * d],
                                                      [0, MASS * d, INERTIA + MASS * d * d]]  # fmt: skip
    return np.sqrt(eigh(stiffness, mass, eigvals_only=True)[3:]) / (2 * np.pi)  # the first three are rigid


def bullet_frequency(joint: Joint, load: float, dt: float = 5e-4, seconds: float = 0.5) -> float:
    """[Hz], of the zeros of the leaf's turn."""
    links = "".join(LINK.format(name=name, centre=sign * CENTRE, mass=MASS, axial=AXIAL, inertia=INERTIA)
                    for name, sign in (("left", -1), ("right", 1)))  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "rod.urdf"
        path.write_text(URDF.format(links=links))
        with FlexibleRobot(path, dt=dt, gravity=(0, 0, 0)) as robot:
            flexure = FlexureJoint(robot, "leaf", joint)
            robot.loads = [Load("left", (load, 0, 0), (-HALF, 0, 0)), Load("right", (-load, 0, 0), (HALF, 0, 0))]
            (tip,) = rod_states(LEAF, np.array([ANGLE]), PART, PART, load).tip
            half = -0.25 * ANGLE  # of the turn that brings the line of the ends along x
            robot.place(robot.place_tip("leaf", [*tip, ANGLE]), pose=[0, 0, 0, 0, 0, np.sin(half), np.cos(half)])
            theta = [ANGLE]
            for _ in range(round(seconds / dt)):
                robot.step()
                theta.append(flexure.pose[2])
    return Vibration(dt * np.arange(len(theta)), np.array(theta), np.zeros(len(theta))).frequency


def rod_rows(loads: tuple[float, ...] = LOADS) -> list[dict[str, float]]:
    """Frequencies at each compression; those of beam, PyBullet and pins as relative differences to the FEM's."""
    joint = fit_joint(LEAF, held_out=0)
    free = rod_pin(LEAF, PART, PART, ANGLE)
    rows = []
    for load in loads:
        exact = float(fem_frequencies(load)[0])
        pressed = rod_pin(LEAF, PART, PART, ANGLE, load)
        rows.append({"load_N": load, "FEM_Hz": exact, "beam": beam_frequency(load) / exact - 1,
                     "PyBullet": bullet_frequency(joint, load) / exact - 1,
                     "pin": pin_frequency(free.stiffness, load) / exact - 1,
                     "pin_fitted_at_load": pin_frequency(pressed.stiffness, load) / exact - 1,
                     "K": pressed.stiffness})  # fmt: skip
    return rows


def other_modes(load: float) -> list[dict[str, object]]:
    """Free modes that the pin leaves out [Hz]: in the plane by the FEM, out of it by the leaf's own section."""
    (leaf,) = LEAF.leaves
    modulus, length = LEAF.material.effective_modulus, LEAF.length
    shear = modulus / (2 * (1 + LEAF.material.poisson_ratio))
    across = modulus * leaf.thickness * leaf.width**3 / 12 / length
    twist = shear * leaf.width * leaf.thickness**3 / 3 / length
    bend, slide, stretch = fem_frequencies(load)
    return [{"mode": "bending, the pin's own", "Hz": bend}, {"mode": "shear in the plane", "Hz": slide},
            {"mode": "stretch", "Hz": stretch},
            {"mode": "bending out of the plane", "Hz": pin_frequency(across, load)},
            {"mode": "twist", "Hz": float(np.sqrt(2 * twist / AXIAL) / (2 * np.pi))}]  # fmt: skip


def show(title: str, rows: list[dict]) -> None:
    cells = [[f"{v:.4g}" if isinstance(v, float) else v for v in row.values()] for row in rows]
    print(f"{title}\n{table(list(rows[0]), cells)}\n")


def main() -> None:
    limit, pin = buckling_load(LEAF, PART, PART), rod_pin(LEAF, PART, PART, ANGLE).buckling_ratio
    print(f"buckling load {limit:.4g} N; the free pin's is {pin:.4g} of it\n")
    show("first bending frequency, relative differences to the FEM's", rod_rows())
    show("free modes at 24.5 N", other_modes(24.5))


if __name__ == "__main__":
    main()
