"""Where PyBullet's engine writes a body's state, so that a substep can read it there.

A DIRECT client answers a request for a state at once: the engine writes it at the start of a buffer there, and only
taking the answer copies it on, 30 kB for every body. The buffer's place is not in the interface. It is found once a
client by what stands there, in memory read through the operating system (an address that is none gives an error, not a
crash), and believed only when the states of all bodies have been seen there. Where it is not found, nothing is lost but
the time of the copies.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray, IntArray

from .c_interface import read_states, request_state

NONE = np.zeros(3, dtype=np.intp)
_MEMORY, _REACH = Path("/proc/self/mem"), 1 << 18  # bytes searched after the status


def find_window(handle: int, body_ids: NDArray[np.int32]) -> IntArray:
    """(3,) address of the client's status, kind of a status that answers with a state, address of the state's pose; all
    0 where that is not sure, or ``handle`` is 0. ``body_ids`` (k,) are the client's.
    """
    if handle == 0 or not len(body_ids) or not _MEMORY.exists():
        return NONE
    none, poses = np.zeros(0, dtype=int), np.zeros((len(body_ids), 7))
    status, kind, copied = request_state(handle, body_ids[-1])
    if not copied or not read_states(handle, NONE, body_ids, none, poses, np.zeros(0)):
        return NONE
    try:
        with _MEMORY.open("rb", buffering=0) as memory:
            memory.seek(status)
            near = memory.read(_REACH)
    except (OSError, ValueError, OverflowError):
        return NONE
    at = near.find(poses[-1].tobytes())
    if at < 0 or at % 8 or status + at == copied:
        return NONE
    window = np.array([status, kind, status + at], dtype=np.intp)
    seen = np.zeros_like(poses)
    known = read_states(handle, window, body_ids, none, seen, np.zeros(0))
    again = request_state(handle, body_ids[0])[0]
    return window if known and again == status and (seen == poses).all() and _distinct(poses) else NONE


def _distinct(poses: FloatArray) -> bool:
    """A window onto one body's state must not pass for one onto all."""
    return len(np.unique(poses, axis=0)) == len(poses)
