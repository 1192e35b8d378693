"""The only package that imports PyBullet. Every call of it names its client.

    engine.py       PyBullet itself, without its greeting
    bodies.py       bodies from URDF files, with nothing of the engine's own in them; the ground
    client.py       Client: a connection with a ground, a camera and gravity
    world.py        BulletWorld: the protocol of engines (tensegym.engine) in a client
    compiled_loop.py  its substeps with no Python in between
    articulated.py  Articulated: a body of many links in a client
    camera.py       Camera: pictures of a client's bodies, and what its window shows
    c_interface.py  PyBullet's C interface, for compiled code
    state_buffer.py where the engine writes a body's state
"""

from .articulated import Articulated
from .bodies import FIXED, PRISMATIC, REVOLUTE, packaged_urdf
from .client import Client
from .world import BulletWorld

__all__ = ["FIXED", "PRISMATIC", "REVOLUTE", "Articulated", "BulletWorld", "Client", "packaged_urdf"]
