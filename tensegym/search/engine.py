"""Engines: where evaluations run. Each is a map that yields outcomes as they come, and leaves their order to others."""

from __future__ import annotations

import importlib
import re
import socket
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from typing import Any, Protocol

from tensegym.errors import InputError, SimulationError

RETRIES = 3  # of a trial whose worker died


class Engine(AbstractContextManager["Engine"], Protocol):
    """``map`` yields ``function(item).number``-ed results in any order, each item once, retrying lost workers."""

    def map(self, function: Callable[[Any], Any], items: Sequence[Any]) -> Iterator[Any]: ...


class JoblibEngine:
    """Processes on this machine; ``jobs`` of them, or none but this one for 1."""

    def __init__(self, jobs: int) -> None:
        self.jobs = jobs

    def __enter__(self) -> JoblibEngine:
        return self

    def __exit__(self, *_: object) -> None:
        if self.jobs > 1:
            from joblib.externals.loky import get_reusable_executor

            get_reusable_executor().shutdown(wait=True)

    def map(self, function: Callable[[Any], Any], items: Sequence[Any]) -> Iterator[Any]:
        from joblib import Parallel, delayed
        from joblib.externals.loky.process_executor import TerminatedWorkerError

        left = list(items)
        for _ in range(1 + RETRIES):
            done: set[int] = set()
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", UserWarning)  # of workers that start anew after one died
                    parallel = Parallel(n_jobs=self.jobs, return_as="generator_unordered", pre_dispatch="all")
                    for result in parallel(delayed(function)(item) for item in left):
                        done.add(result.number)
                        yield result
                return
            except TerminatedWorkerError:
                left = [item for item in left if item.number not in done]
        raise SimulationError(f"trial {left[0].number}: its worker died {1 + RETRIES} times")


class RayEngine:
    """A Ray cluster at ``address``, or one started here with ``jobs`` workers."""

    def __init__(self, jobs: int, address: str | None) -> None:
        import ray

        self._ray = ray
        options: dict[str, Any] = {"address": address} if address else {"num_cpus": jobs, "include_dashboard": False}
        try:
            ray.init(logging_level="error", log_to_driver=False, ignore_reinit_error=True, **options)
        except (ConnectionError, RuntimeError, ValueError) as error:
            raise InputError(f"no Ray cluster answers at {address!r}: {str(error).splitlines()[0]}") from error

    def __enter__(self) -> RayEngine:
        return self

    def __exit__(self, *_: object) -> None:
        self._ray.shutdown()

    def map(self, function: Callable[[Any], Any], items: Sequence[Any]) -> Iterator[Any]:
        remote = self._ray.remote(max_retries=RETRIES, num_cpus=1)(function)
        waiting = [remote.remote(item) for item in items]
        while waiting:
            ready, waiting = self._ray.wait(waiting)
            yield from self._ray.get(ready)


def check_engine(name: str, address: str | None = None) -> None:
    """Raises InputError for an engine there is not, or an address of host and port at which nothing listens.

    Raises ModuleNotFoundError where the engine's library is missing. Ray itself takes minutes to give an address up.
    """
    if name not in ("joblib", "ray"):
        raise InputError(f"engine = {name!r} is not one of joblib, ray")
    importlib.import_module(name)
    place = re.fullmatch(r"(?:ray://)?([^:/]+):(\d{1,5})", address or "")
    if not place:
        return
    try:
        socket.create_connection((place[1], int(place[2])), timeout=5).close()
    except OSError as error:
        raise InputError(f"no Ray cluster answers at address = {address!r}: {error}") from error


def engine(name: str, jobs: int, address: str | None = None) -> Engine:
    """By name: joblib or ray. Raises as `check_engine`, or InputError where no cluster answers."""
    check_engine(name, address)
    return RayEngine(jobs, address) if name == "ray" else JoblibEngine(jobs)
