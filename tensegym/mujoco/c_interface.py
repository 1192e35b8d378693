"""MuJoCo's C interface, called from compiled code: a substep with no Python in between.

`mj_step` takes the addresses of a model and its data, and the arrays of both are NumPy arrays of Python's, so that it
alone has to be found.
"""

from __future__ import annotations

import ctypes
from pathlib import Path

import llvmlite.binding as llvm
import mujoco
from numba import types

from tensegym.compiled import kernel
from tensegym.engine.leapfrog import engine_substep
from tensegym.physics.vectors import ALLOCATING, KERNEL

_step = types.ExternalFunction("mj_step", types.void(types.intp, types.intp))


def _bind() -> bool:
    """Make `mj_step` known to the compiler; False where the library is not found by its name."""
    folder = Path(mujoco.__file__).parent
    for path in [*folder.glob("libmujoco*"), *folder.glob("mujoco.dll")]:
        try:
            library = ctypes.CDLL(str(path))
            llvm.add_symbol("mj_step", ctypes.cast(library.mj_step, ctypes.c_void_p).value or 0)
        except (AttributeError, OSError):
            continue
        return True
    return False


@kernel(**KERNEL)
def read_poses(places, pins, coordinates, poses, angles):
    """Write poses (k, 7), position and xyzw, and angles (p,) from coordinates (q,), whose quaternions are wxyz; places
    (k,), pins (p,): where each body's and each pin's begin."""
    for b in range(len(places)):
        at = places[b]
        for i in range(3):
            poses[b, i], poses[b, 3 + i] = coordinates[at + i], coordinates[at + 4 + i]
        poses[b, 6] = coordinates[at + 3]
    for p in range(len(pins)):
        angles[p] = coordinates[pins[p]]


@kernel(**KERNEL)
def write_wrenches(links, wrenches, applied):
    """Write force and moment of every link into MuJoCo's array of them; links (l,): their rows there."""
    for link in range(len(links)):
        for i in range(6):
            applied[links[link], i] = wrenches[link, i]


@kernel(**ALLOCATING)
def run(count, engine, model, ground, state, out, dt, implicit):
    """Take ``count`` time steps; engine: a world.EngineAccess, the rest as for `substep`."""
    for _ in range(count):
        read_poses(engine.places, engine.pins, engine.coordinates, state.poses, state.angles)
        engine_substep(model, ground, state, out, dt, implicit)
        write_wrenches(engine.links, out.wrenches, engine.applied)
        _step(engine.model, engine.data)


AVAILABLE = _bind()
