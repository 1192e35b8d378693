"""What a robot needs of an engine, and nothing of any engine.

    scene.py           Scene: what stands in a world
    world.py           World: the protocol that engines implement, and a contact of it
    uncopied.py        Uncopied: base of what is not copied; Closed: in place of a world that was closed
    leapfrog.py        what makes an engine's explicit step one of the leapfrog; rod_rotation.py, split_rod_step.py and
                       joint_step.py are its parts

`tensegym.bullet` and `tensegym.mujoco` implement it; `tensegym.robot.engines` picks one by name.
"""

from .scene import Scene
from .uncopied import Closed, Uncopied
from .world import GROUND, Contact, State, World

__all__ = ["GROUND", "Closed", "Contact", "Scene", "State", "Uncopied", "World"]
