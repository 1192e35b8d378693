"""Robots in PyBullet whose joints are fitted flexures: from Python, or declared beside a URDF in a TOML file.

    from tensegym.flexible import FlexibleRobot, FlexureJoint

    with FlexibleRobot("leg.urdf", ground=True) as robot:
        knee = FlexureJoint(robot, "knee", "leaf.json", loss_time=1e-3)
        robot.step(1000)
        print(knee.pose, knee.wrench, knee.energy, knee.margin)

    flexible_robot.py   FlexibleRobot; flexure_joint.py: FlexureJoint; load.py: Load
    flexure_file.py     load_robot: the TOML file
    urdf_audit.py       a user's URDF looked through before loading; urdf_meshes.py: its files; urdf_xml.py: its XML
    urdf_rewrite.py     a named revolute joint becomes a chain of joints; flexible_urdf.py: FlexibleUrdf, the whole text
    tree.py             links as arrays; tree_kernel.py: their equations of motion
    springs.py          fitted models as arrays; spring_kernel.py: energy, gradient, Hessian, margin
    step_kernel.py      the forces that make PyBullet take a trapezoidal step; contacts.py: the ground foreseen
    stepper.py          Stepper: the state as the engine has it, and its step
    stand.py            the paper's stand
"""

from .flexible_robot import FlexibleRobot
from .flexure_file import load_robot
from .flexure_joint import FlexureJoint, Outside
from .load import Load

__all__ = ["FlexibleRobot", "FlexureJoint", "Load", "Outside", "load_robot"]
