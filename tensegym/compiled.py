"""`kernel`: a function compiled by numba, whose machine code is kept on disk for as long as no kernel's source changes.

Numba alone keys what it keeps on one file. Kernels inline one another over many, so after a change in one of them it
would go on with the old physics. Here a folder of compiled code belongs to the sources of all modules with kernels and
to the versions that compiled them; another one replaces it. Modules count whose text names this one: those with
kernels, and those without that kernels take a number from.
"""

from __future__ import annotations

import hashlib
import logging
import multiprocessing
import os
import pickle
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import llvmlite
import numba
import numpy as np
from numba.core.caching import FunctionCache

PACKAGE = Path(__file__).parent
_MARK = b"tensegym.compiled"  # what a source says that counts


def kernel(function: Any = None, **options: Any) -> Any:
    """``@kernel`` or ``@kernel(inline="always", ...)``: `numba.njit` with its options, and the compiled code kept.

    To a type checker the compiled function is Any, as numba's own is: its docstring says what goes in and out.
    """
    if function is None:
        return lambda function: kernel(function, **options)
    dispatcher = numba.njit(**options)(function)
    folder = cache_folder()
    if folder is not None:
        before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(folder)
        try:
            dispatcher._cache = _Cache(function)  # what `cache=True` does, with numba's own class
        except (OSError, RuntimeError) as error:
            _tell(str(error))
        finally:
            numba.config.CACHE_DIR = before
    return dispatcher


@lru_cache(maxsize=1)
def sources_hash() -> str:
    """Of the sources of all modules that count and the versions that compile them; found once a process."""
    digest = hashlib.sha256(repr((numba.__version__, llvmlite.__version__, np.__version__)).encode())
    for path in _sources(str(PACKAGE)):
        with open(path, "rb") as file:
            source = file.read()
        if _MARK in source:
            digest.update(path.encode() + b"\0" + source)
    return digest.hexdigest()[:16]


def _sources(folder: str) -> Iterator[str]:
    for entry in sorted(os.scandir(folder), key=lambda entry: entry.name):
        if entry.is_dir() and entry.name != "__pycache__":
            yield from _sources(entry.path)
        elif entry.name.endswith(".py"):
            yield entry.path


@lru_cache(maxsize=1)
def cache_folder() -> Path | None:
    """Where compiled code is kept: beside the package, or else in the user's cache; None where neither can be written.

    Numba's own setting, NUMBA_CACHE_DIR, comes before both.
    """
    where = hashlib.sha256(str(PACKAGE).encode()).hexdigest()[:8]
    own = numba.config.CACHE_DIR
    places = [Path(own)] if own else [PACKAGE / "__pycache__", _user_cache() / "tensegym"]
    for place in places:
        folder = place / f"kernels-{where}-{sources_hash()}"
        try:
            if not folder.is_dir():
                folder.mkdir(parents=True, exist_ok=True)
                for old in place.glob(f"kernels-{where}-*"):
                    if old != folder:
                        shutil.rmtree(old, ignore_errors=True)
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return folder
    _tell(f"{' and '.join(map(str, places))} cannot be written; NUMBA_CACHE_DIR names another folder")
    return None


def _user_cache() -> Path:
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or os.path.expanduser("~/AppData/Local"))
    apple = sys.platform == "darwin"
    return Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/Library/Caches" if apple else "~/.cache"))


class _Cache(FunctionCache):
    """Numba's own, but what cannot be read is compiled, and what cannot be written is not kept."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(sig, target_context)
        except (OSError, EOFError, pickle.UnpicklingError):
            with suppress(OSError):
                self.flush()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _tell(str(error))


_told = False


def _tell(reason: str) -> None:
    """Say once, and in worker processes not at all, that kernels are compiled at every start."""
    global _told
    if not _told and multiprocessing.parent_process() is None:
        logging.getLogger("tensegym").warning(
            "tensegym: compiled kernels are not kept, and every start takes a minute to compile them: %s", reason
        )
    _told = True
