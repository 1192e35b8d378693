"""PyBullet's C interface, called from compiled code: a substep's reads, forces and step with no Python in between.

The extension module exports the whole interface but for the way from a client's number to its handle, which is a local
function. The file's symbol table says where that stands. Where it does not (another system's file format, a stripped
build) AVAILABLE is False, and the Python calls of `bullet` do the work: they are the reference, and both give the same
bits.

What the functions take and what a status holds are those of the versions in KNOWN_VERSIONS; another version is not
driven this way, AVAILABLE being False.

Only clients of the DIRECT kind may be driven this way: they have done a command when the call that submits it returns.
"""

from __future__ import annotations

import ctypes
import importlib.util
import mmap
import struct
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import llvmlite.binding as llvm
import numpy as np
from numba import types
from numba.extending import intrinsic

from tensegym.compiled import kernel

_WORLD_FRAME, _BASE = 2, -1
KNOWN_VERSIONS = {"pybullet": ("3.2.7",), "pybullet-arm64": ("3.2.8",)}  # by distribution
_EXPORTED = ("b3GetNumBodies", "b3SubmitClientCommand", "b3ProcessServerStatus", "b3InitStepSimulationCommand",
             "b3RequestActualStateCommandInit", "b3GetStatusActualState", "b3ApplyExternalForceCommandInit",
             "b3ApplyExternalForce", "b3ApplyExternalTorque", "b3GetStatusType")  # fmt: skip

_int, _word = types.int32, types.intp  # handles and pointers are passed as machine words
_handle_of = types.ExternalFunction("tensegym_handle_of_client", _word(_int))
_number_of_bodies = types.ExternalFunction("b3GetNumBodies", _int(_word))
_submit = types.ExternalFunction("b3SubmitClientCommand", _int(_word, _word))
_status = types.ExternalFunction("b3ProcessServerStatus", _word(_word))
_kind_of = types.ExternalFunction("b3GetStatusType", _int(_word))
_step_command = types.ExternalFunction("b3InitStepSimulationCommand", _word(_word))
_state_command = types.ExternalFunction("b3RequestActualStateCommandInit", _word(_word, _int))
_actual_state = types.ExternalFunction("b3GetStatusActualState", _int(*[_word] * 8))
_force_command = types.ExternalFunction("b3ApplyExternalForceCommandInit", _word(_word))
_add_force = types.ExternalFunction("b3ApplyExternalForce", types.void(_word, _int, _int, _word, _word, _int))
_add_torque = types.ExternalFunction("b3ApplyExternalTorque", types.void(_word, _int, _int, _word, _int))


def installed() -> dict[str, str]:
    """Version of the PyBullet that is installed, by its distribution: one, unless both were by hand."""
    found = {}
    for name in KNOWN_VERSIONS:
        with suppress(PackageNotFoundError):
            found[name] = version(name)
    return found


def known_version() -> bool:
    """Whether the installed PyBullet is one whose interface is known here."""
    found = installed()
    return bool(found) and all(number in KNOWN_VERSIONS[name] for name, number in found.items())


def known_names() -> str:
    """The known versions in words."""
    return ", ".join(f"{name} {number}" for name, numbers in KNOWN_VERSIONS.items() for number in numbers)


def _bind() -> bool:
    """Make the functions above known to the compiler under their names; False where one of them is missing, or the
    version is not known."""
    if not known_version():
        return False
    spec = importlib.util.find_spec("pybullet")
    if spec is None or spec.origin is None:
        return False
    try:
        library = ctypes.CDLL(spec.origin)
        addresses = {name: ctypes.cast(getattr(library, name), ctypes.c_void_p).value or 0 for name in _EXPORTED}
        local = local_symbols(Path(spec.origin), ("getPhysicsClient", *_EXPORTED))
        loaded_at = {addresses[name] - local[name] for name in _EXPORTED}
    except (AttributeError, KeyError, OSError, ValueError, struct.error):
        return False
    if len(loaded_at) != 1:
        return False  # the table is another file's
    addresses["tensegym_handle_of_client"] = loaded_at.pop() + local["getPhysicsClient"]
    for name, address in addresses.items():
        llvm.add_symbol(name, address)
    return True


def local_symbols(path: Path, names: tuple[str, ...]) -> dict[str, int]:
    """Offset in the loaded image of every symbol of ``names`` that the file's full symbol table holds once.

    64-bit little-endian ELF; ValueError for another format. System V ABI, chapter 4.
    """
    row = np.dtype([("name", "<u4"), ("info", "u1"), ("other", "u1"), ("section", "<u2"), ("value", "<u8"),
                    ("size", "<u8")])  # fmt: skip
    symbol_table = 2
    found = {}
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        if data[:6] != b"\x7fELF\x02\x01":
            raise ValueError(f"{path.name} is no 64-bit little-endian ELF file")
        (start,), (size, count) = struct.unpack_from("<Q", data, 40), struct.unpack_from("<HH", data, 58)
        sections = [struct.unpack_from("<IIQQQQIIQQ", data, start + i * size) for i in range(count)]
        for _, kind, _, _, offset, length, link, *_ in sections:
            if kind != symbol_table:
                continue
            text = sections[link][4]
            table = np.frombuffer(data[offset : offset + length], dtype=row)
            for name in names:
                at = data.find(b"\0" + name.encode() + b"\0", text, text + sections[link][5]) + 1
                values = table["value"][table["name"] == at - text] if at else []
                if len(values) == 1:
                    found[name] = int(values[0])
    return found


@intrinsic
def doubles(_, word):
    """The double precision numbers at an address."""

    def generate(context, builder, signature, arguments):
        return builder.inttoptr(arguments[0], context.get_value_type(types.CPointer(types.float64)))

    return types.CPointer(types.float64)(word), generate


@kernel
def client_handle(client, bodies):
    """Handle of a DIRECT client by its number; 0 unless it is connected and holds ``bodies`` bodies."""
    handle = _handle_of(client)
    return handle if handle != 0 and _number_of_bodies(handle) == bodies else 0


@kernel
def request_state(handle, body):
    """Ask for a body's state by the interface's own way: address of the status, kind of it, address of the copied state
    (7 numbers of the pose, then the joints'); the last is 0 where the engine knows no such body."""
    slot = np.zeros(1, np.intp)
    _submit(handle, _state_command(handle, body))
    status = _status(handle)
    _actual_state(status, 0, 0, 0, 0, slot.ctypes.data, 0, 0)
    return status, _kind_of(status), slot[0]


@kernel
def read_states(handle, window, body_ids, two_link_rows, poses, angles):
    """Write poses (k, 7), position and xyzw, of the bodies' first links, and angles (p,) of the pins of the rows
    ``two_link_rows`` (p,); False where the engine knows one of the bodies no more.

    window: see state_buffer.py; all 0 takes the interface's own way, which copies 30 kB a body.
    """
    pin = 0
    for b in range(len(body_ids)):
        if window[0] == 0:
            _, _, address = request_state(handle, body_ids[b])
            known = address != 0
        else:
            _submit(handle, _state_command(handle, body_ids[b]))
            known, address = _kind_of(window[0]) == window[1], window[2]
        if not known:
            return False
        values = doubles(address)
        for i in range(7):
            poses[b, i] = values[i]
        if pin < len(two_link_rows) and two_link_rows[pin] == b:
            angles[pin] = values[7]
            pin += 1
    return True


@kernel
def push_and_step(handle, body_ids, two_link_rows, poses, wrenches):
    """Give the bodies ``wrenches`` (k + p, 6) as `World.step` does and advance one time step.

    One command each: in a command of several, the interface writes each force over the one before (PyBullet 3.2.7).
    """
    row = wrenches.strides[0]
    for b in range(len(body_ids)):
        wrench = wrenches.ctypes.data + b * row
        command = _force_command(handle)
        _add_force(command, body_ids[b], _BASE, wrench, poses.ctypes.data + b * poses.strides[0], _WORLD_FRAME)
        _submit(handle, command)
        command = _force_command(handle)
        _add_torque(command, body_ids[b], _BASE, wrench + 24, _WORLD_FRAME)
        _submit(handle, command)
    for p in range(len(two_link_rows)):
        moment = wrenches.ctypes.data + (len(body_ids) + p) * row + 24
        command = _force_command(handle)
        _add_torque(command, body_ids[two_link_rows[p]], 0, moment, _WORLD_FRAME)
        _submit(handle, command)
    _submit(handle, _step_command(handle))
    _status(handle)


AVAILABLE = _bind()
