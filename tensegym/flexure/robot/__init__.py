"""Robots in PyBullet whose joints are fitted flexures: from Python, or declared beside a URDF in a TOML file.

    urdf_rewrite.py     a named revolute joint becomes a chain of joints in the URDF's text
    tree.py             links as arrays; tree_kernel.py: their equations of motion
    springs.py          fitted models as arrays; spring_kernel.py: energy, gradient, Hessian, margin
    step_kernel.py      the forces that make PyBullet take a trapezoidal step
    flexure_joint.py    FlexureJoint; flexible_robot.py: FlexibleRobot; flexure_file.py: the TOML file
"""

from .flexible_robot import Energies, FlexibleRobot, Load
from .flexure_joint import FlexureJoint, Outside

__all__ = ["Energies", "FlexibleRobot", "FlexureJoint", "Load", "Outside"]
