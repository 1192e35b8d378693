"""Files that are whole or not there, folders that one command works in at a time, and versions of what is written."""

from __future__ import annotations

import json
import os
import shutil
import socket
import sys
from collections import defaultdict
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any, TextIO

from tensegym.errors import InputError

VERSION = 1  # of the files written here that have one
_OWN = ".tensegym-"  # how the names of files begin that are there while a command runs
_OLD = _OWN + "old-"  # and those of folders for the moment between the old and the new one
_LOCK = _OWN + "lock"


@contextmanager
def replace_path(path: Path) -> Iterator[Path]:
    """A name beside ``path`` to make a file or a folder at, which takes the place of ``path`` if the block ends well.

    What was at ``path`` stays until then, and for good if the block fails. The name ends as that of ``path``. A device
    or a pipe, such as /dev/stdout, is written to as it is.
    """
    path = Path(os.path.realpath(path))
    if path.exists() and not (path.is_file() or path.is_dir()):
        yield path
        return
    fresh = path.with_name(f"{_OWN}{os.getpid()}-{path.name}")
    _remove(fresh)
    try:
        yield fresh
        if fresh.is_dir():
            for file in fresh.rglob("*"):
                _sync(file)
            old = path.with_name(f"{_OLD}{path.name}")
            _remove(old)
            if path.exists():
                os.replace(path, old)
            os.replace(fresh, path)
            _remove(old)
        else:
            _sync(fresh)
            os.replace(fresh, path)
    finally:
        _remove(fresh)


@contextmanager
def replace_file(path: Path) -> Iterator[TextIO]:
    """Open a text file (UTF-8) for writing; it takes the place of ``path`` if the block ends well."""
    with replace_path(path) as fresh, fresh.open("w", newline="", encoding="utf-8") as file:
        yield file


def write_text(path: Path, text: str) -> None:
    """Write a file that is whole or, as before, not there."""
    with replace_file(path) as file:
        file.write(text)


def write_json(path: Path, data: dict[str, Any]) -> None:
    """Write plain data, with the version of its form, in a file that is whole or not there."""
    write_text(path, json.dumps({"version": VERSION, **data}, indent=1, allow_nan=False) + "\n")


def without_version(data: dict[str, Any], path: Path | str) -> dict[str, Any]:
    """Data from a file less its version. Raises InputError where that is newer than this program's."""
    version = data.get("version", 0)
    if isinstance(version, bool) or not isinstance(version, int) or version > VERSION:
        raise InputError(f"{path} is of version {version!r}, this tensegym reads up to {VERSION}: install a newer one")
    return {key: value for key, value in data.items() if key != "version"}


def check_file(path: Path) -> None:
    """Look whether a file can be written at a path. Raises FileNotFoundError or InputError, before anything is done."""
    if not path.parent.is_dir():
        raise FileNotFoundError(f"no folder {path.parent} to write {path.name} in")
    if path.is_dir():
        raise InputError(f"{path} is a folder; give a file")


def is_empty(folder: Path, but: Collection[str] = ()) -> bool:
    """Whether a folder is missing, or holds nothing ``but`` these and what a killed command left half written."""
    return not folder.exists() or all(e.name.startswith(_OWN) or e.name in but for e in folder.iterdir())


@contextmanager
def lock_folder(folder: Path) -> Iterator[None]:
    """Work in a folder that no other command of this package works in; it is made, and removed if it stays empty.

    A command that was killed holds no lock, and what it left half written is removed.

    Raises:
        InputError: another command works there (which is named), or there is a file of that name.
    """
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder} is a file; give a folder")
    made = [parent for parent in (folder, *folder.parents) if not parent.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / _LOCK
    descriptor = _locked(path)
    try:
        _tidy(folder)
        holder = {"process": os.getpid(), "host": socket.gethostname(), "since": f"{datetime.now():%Y-%m-%d %H:%M:%S}",
                  "command": " ".join([Path(sys.argv[0]).name, *sys.argv[1:3]])}  # fmt: skip
        os.truncate(descriptor, 0)
        os.pwrite(descriptor, json.dumps(holder).encode(), 0)
        yield
    finally:
        path.unlink(missing_ok=True)
        os.close(descriptor)
        for each in made:
            if any(each.iterdir()):
                break
            each.rmdir()


def _tidy(folder: Path) -> None:
    """Put back or remove what killed commands left half done."""
    for left in sorted(folder.rglob(_OWN + "*")):
        whole = left.with_name(left.name.removeprefix(_OLD))
        if left.name.startswith(_OLD) and not whole.exists():
            os.replace(left, whole)
        elif left.name != _LOCK and not _alive(left.name.removeprefix(_OWN).split("-")[0]):
            _remove(left)


def _alive(process: str) -> bool:
    """Whether there is another process of that number; a number that is none is none's."""
    if sys.platform == "win32":
        return process.isdigit()
    try:
        os.kill(int(process), 0)
    except PermissionError:
        return True
    except (ValueError, ProcessLookupError):
        return False
    return int(process) != os.getpid()


def _locked(path: Path) -> int:
    """Descriptor of the lock file, locked. Raises InputError where another process has it."""
    while True:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            if not _try_lock(descriptor, path):
                raise InputError(_in_use(path))
            if path.exists() and os.path.samestat(os.fstat(descriptor), path.stat()):
                return descriptor
        except BaseException:
            os.close(descriptor)
            raise
        os.close(descriptor)  # removed by who held it, between opening and locking


def _try_lock(descriptor: int, path: Path) -> bool:
    if sys.platform == "win32":
        import msvcrt

        os.lseek(descriptor, 1 << 20, os.SEEK_SET)  # beyond what is written, which others may read
        try:
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        except OSError:
            return False
        return True
    import fcntl

    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks: believe what its last holder wrote
        holder = _holder(path)
        return holder.get("host") != socket.gethostname() or not _alive(str(holder.get("process")))
    return True


def _holder(path: Path) -> dict[str, Any]:
    try:
        return dict(json.loads(path.read_text()))
    except (OSError, ValueError, TypeError):
        return {}


def _in_use(path: Path) -> str:
    who = "`{command}`, process {process} on {host}, since {since}".format_map(defaultdict(lambda: "?", _holder(path)))
    return f"{path.parent} is in use by {who}: wait for it, end it, or take another folder"


def _sync(path: Path) -> None:
    """Bring a file to the disk, so that a full one is noticed before the old file goes."""
    if path.is_file():
        with path.open("rb+") as file:
            os.fsync(file.fileno())


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)
