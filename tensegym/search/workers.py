"""Workers: where evaluations run. Each is a map that yields outcomes as they come, and leaves their order to others."""

from __future__ import annotations

import importlib.util
import os
import re
import secrets
import socket
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from typing import Any, Protocol

from tensegym.errors import InputError
from tensegym.processes import RETRIES, Pool


class Workers(AbstractContextManager["Workers"], Protocol):
    """``map`` yields each item's result once, in any order; an item whose worker was lost is tried again."""

    def map(self, function: Callable[[Any], Any], items: Sequence[Any]) -> Iterator[Any]: ...


class RayWorkers:
    """A Ray cluster at ``address``, or one started here with ``jobs`` workers, for this machine and user alone."""

    def __init__(self, jobs: int, address: str | None) -> None:
        options: dict[str, Any] = {"address": address}
        if not address:
            options = {"num_cpus": jobs, "include_dashboard": False}
            _keep_to_this_machine()
        import ray

        self._ray = ray
        try:
            ray.init(logging_level="error", log_to_driver=False, ignore_reinit_error=True, **options)
        except (ConnectionError, RuntimeError, ValueError) as error:
            raise InputError(f"no Ray cluster answers at {address!r}: {str(error).splitlines()[0]}") from error

    def __enter__(self) -> RayWorkers:
        return self

    def __exit__(self, *_: object) -> None:
        self._ray.shutdown()

    def map(self, function: Callable[[Any], Any], items: Sequence[Any]) -> Iterator[Any]:
        remote = self._ray.remote(max_retries=RETRIES, num_cpus=1)(function)
        waiting = [remote.remote(item) for item in items]
        while waiting:
            ready, waiting = self._ray.wait(waiting)
            yield from self._ray.get(ready)


def _keep_to_this_machine() -> None:
    """Let a Ray started here listen on loopback alone, and answer those only who know a token.

    Ray reads this when it is imported, so it is set before. Raises InputError where Ray was imported without.
    """
    if "RAY_AUTH_MODE" in os.environ:  # set here before, or by a user who knows Ray
        return
    if "ray" in sys.modules and not sys.modules["ray"].is_initialized():
        raise InputError("ray was imported before its workers were made, and would listen on the network: "
                         "make the workers first, or set RAY_AUTH_MODE before the import")  # fmt: skip
    os.environ |= {"RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER": "0", "RAY_AUTH_MODE": "token",
                   "RAY_AUTH_TOKEN": secrets.token_hex(32)}  # fmt: skip


def check_workers(name: str, address: str | None = None) -> None:
    """Raises InputError for workers there are not, or an address of host and port at which nothing listens.

    Raises ModuleNotFoundError where their library is missing. Ray itself takes minutes to give an address up.
    """
    if name not in ("local", "joblib", "ray"):
        raise InputError(f"workers = {name!r} is not one of local, ray")
    if name == "ray" and importlib.util.find_spec(name) is None:
        raise ModuleNotFoundError("No module named 'ray'", name=name)
    place = re.fullmatch(r"(?:ray://)?([^:/]+):(\d{1,5})", address or "")
    if not place:
        return
    try:
        socket.create_connection((place[1], int(place[2])), timeout=5).close()
    except OSError as error:
        raise InputError(f"no Ray cluster answers at address = {address!r}: {error}") from error


def open_workers(name: str, jobs: int, address: str | None = None) -> Workers:
    """By name: ray, or local (joblib, as it was called once) for processes of this machine.

    Raises as `check_workers`, or InputError where no cluster answers.
    """
    check_workers(name, address)
    return RayWorkers(jobs, address) if name == "ray" else Pool(jobs)
