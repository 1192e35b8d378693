"""Robots in PyBullet whose joints are fitted flexures: from Python, or declared beside a URDF in a TOML file.

    urdf_rewrite.py     a named revolute joint becomes a chain of joints in the URDF's text
    tree.py             links as arrays; tree_kernel.py: their equations of motion
    springs.py          fitted models as arrays; spring_kernel.py: energy, gradient, Hessian, margin
    step_kernel.py      the forces that make PyBullet take a trapezoidal step; contacts.py: the ground foreseen
    stepper.py          Stepper: the state as the engine has it, and its step
    flexible_urdf.py    FlexibleUrdf: the text with its flexures; load.py: Load; energies.py: Energies
    flexure_joint.py    FlexureJoint; flexible_robot.py: FlexibleRobot; flexure_file.py: the TOML file
    stand.py            the paper's stand; stand_pictures.py
"""

from .energies import Energies
from .flexible_robot import FlexibleRobot
from .flexure_joint import FlexureJoint, Outside
from .load import Load

__all__ = ["Energies", "FlexibleRobot", "FlexureJoint", "Load", "Outside"]
