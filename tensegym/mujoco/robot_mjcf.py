"""MJCF of a whole robot, for those who go on in MuJoCo: its cables are MuJoCo's own tendons, its winches actuators.

What MuJoCo has not is left out: the damping of a rod's spin about its axis, the motor, gear and backlash of a drive.
The damper of an elastic cable acts while it is slack too. A winch is an actuator whose control is the length wound in
[m], and whose force is that of the stiff cable, cut off where it would push.
"""

from __future__ import annotations

from tensegym.arrays import FloatArray
from tensegym.design.bodies import design_bodies
from tensegym.design.design import RobotDesign
from tensegym.physics.model import DAMPING, END_A, END_B, STIFFNESS, TWO_WAY
from tensegym.physics.robot_arrays import explicit_step_limit, robot_model
from tensegym.physics.terrain import FLAT

from .mjcf import body_mjcf, ground_mjcf, mjcf, option_mjcf, text

TIME_STEPS = (1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5)  # s
LIGHT = '    <light pos="0 0 4" dir="0 0 -1" directional="true"/>'


def robot_mjcf(
    design: RobotDesign, poses: FloatArray | None = None, *, dt: float | None = None, integrator: str = "RK4",
    ground: bool = True,
) -> str:  # fmt: skip
    """A file's text.

    Args:
        design: the robot.
        poses: (b, 7) of its bodies, of halves of split rods the first ones count; default: unrotated.
        dt: time step [s]; default: the largest of TIME_STEPS that its cables' forces are stable at.
        integrator: MuJoCo's name of it. With Euler, and with implicitfast, rods as thin as these gain momentum.
        ground: the plane z = 0 and gravity, or neither.
    """
    model = robot_model(design)
    poses = model.rest_poses if poses is None else poses
    limit = explicit_step_limit(model)
    dt = dt or next((step for step in TIME_STEPS if step <= limit), TIME_STEPS[-1])
    bodies, rods, names = design_bodies(design), design.standing.rods + 1, cable_names(design)
    centres = [0.0] * len(model.masses)
    for second, first in zip(model.pin_bodies[:, 1], model.pin_bodies[:, 0], strict=True):
        link = bodies[first].second
        centres[second] = link.centre if link else 0.0
    sites: list[list[str]] = [[] for _ in model.masses]
    tendons, winches = [], []
    for row, name in enumerate(names):
        params, rest = model.spring_params[row], model.rest_lengths[row]
        for side, end in enumerate((END_A, END_B)):
            body = model.spring_bodies[row, side]
            place = params[end] + [0, 0, centres[body]]
            sites[body].append(f'      <site name="{name}_{"ab"[side]}" pos="{text(place)}" size="0.003"/>')
        stiffness, damping, driven = params[STIFFNESS], params[DAMPING], row in range(len(names))[model.driven]
        slack = f"{rest:.17g}" if params[TWO_WAY] else f"0 {rest:.17g}"
        spring = "" if driven else f' stiffness="{stiffness:.17g}" damping="{damping:.17g}" springlength="{slack}"'
        tendons.append(f'    <spatial name="{name}"{spring} width="0.002"><site site="{name}_a"/>'
                       f'<site site="{name}_b"/></spatial>')  # fmt: skip
        if driven:
            pull = design.each_stiff_cable[row - model.first_driven].max_pull
            winches.append(
                f'    <general name="winch_{name}" tendon="{name}" gaintype="fixed" gainprm="{-stiffness:.17g}" '
                f'biastype="affine" biasprm="{text([stiffness * rest, -stiffness, -damping])}" forcerange="-1e6 0" '
                f'ctrlrange="0 {pull * rest:.17g}"/>'
            )
    parts = []
    for row, body in enumerate(bodies):
        name = f"rod_{rods[row][0]}_{rods[row][1]}" if row < len(rods) else body.name
        other = model.other_half[row]
        pin = _flexure(design, row) if other >= 0 else ""
        links = ["\n".join(sites[row]), "\n".join(sites[other]) if other >= 0 else ""]
        parts.append(body_mjcf(body, poses[row], name, links, pin, seen=True))
    _, floor = ground_mjcf(FLAT if ground else None)
    option = option_mjcf(dt, design.gravity if ground else 0.0, integrator)
    rest_of_it = ["  <tendon>", *tendons, "  </tendon>"]
    if winches:
        rest_of_it += ["  <actuator>", *winches, "  </actuator>"]
    return mjcf(design.name, option, design.friction, [], [LIGHT, *floor, *parts], rest_of_it)


def cable_names(design: RobotDesign) -> list[str]:
    """Names of all cables in the order of the kernel's rows, by the nodes they join, counted from 1."""
    structure = design.structure
    kinds = {"cable": structure.cables, "stiff": structure.stiff_cables}
    if design.payload:
        kinds["payload"] = structure.rods
    return [f"{kind}_{a}_{b}" for kind, pairs in kinds.items() for a, b in pairs + 1]


def _flexure(design: RobotDesign, rod: int) -> str:
    """Attributes of a pin's joint: the flexure's spring and damper."""
    stiffness, loss = design.rod_pins[rod].stiffness, design.flexure.loss_time if design.flexure else 0.0
    return f' stiffness="{stiffness:.17g}" damping="{loss * stiffness:.17g}"'
