"""The only package that imports PyBullet. Every call of it names its client.

    engine.py       PyBullet itself, without its greeting
    bodies.py       bodies from URDF files, with nothing of the engine's own in them; the ground
    world.py        World: a client with bodies of one link or two, and its time step
    articulated.py  Articulated: a body of many links in a world
    camera.py       Camera: pictures of a world, and what its window shows
    c_interface.py  PyBullet's C interface, for compiled code
    state_buffer.py where the engine writes a body's state
"""

from .articulated import Articulated
from .bodies import FIXED, PRISMATIC, REVOLUTE, packaged_urdf
from .world import World

__all__ = ["FIXED", "PRISMATIC", "REVOLUTE", "Articulated", "World", "packaged_urdf"]
