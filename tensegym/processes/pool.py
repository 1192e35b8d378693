"""The process map: a function of many items over workers, each item once, whoever dies."""

from __future__ import annotations

import pickle
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from multiprocessing.connection import wait
from typing import Any, TypeVar

import numpy as np

from tensegym.errors import InputError
from tensegym.progress import progress_bar

from .worker import Worker, WorkerDied, cores

Item = TypeVar("Item")
Result = TypeVar("Result")

RETRIES = 3  # of an item whose worker died


class Pool:
    """Workers that stay for several maps.

    Args:
        jobs: worker processes; 0 for one a core, 1 for none: the work is done in this process.

    Raises:
        InputError: jobs is no whole number, 0 or more.
    """

    def __init__(self, jobs: int = 0) -> None:
        if isinstance(jobs, bool) or not isinstance(jobs, int | np.integer) or jobs < 0:
            raise InputError(f"jobs = {jobs!r} must be a whole number: 1 or more processes, or 0 for one a core")
        self.jobs = int(jobs) or cores()
        self._idle: list[Worker] = []

    def __enter__(self) -> Pool:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the workers."""
        while self._idle:
            self._idle.pop().close()

    def map(
        self, function: Callable[[Item], Result], items: Iterable[Item], *, bar: str | None = None, unit: str = "item",
        retries: int = RETRIES, name: Callable[[Item], str] = str,
    ) -> Iterator[Result]:
        """As `process_map`, with the workers of this pool."""
        listed = list(items)
        results = _here(function, listed) if self.jobs == 1 else self._over(function, listed, retries, name)
        return results if bar is None else _with_bar(results, len(listed), bar, unit)

    def _over(
        self, function: Callable[[Item], Result], items: list[Item], retries: int, name: Callable[[Item], str]
    ) -> Iterator[Result]:
        pickled = pickle.dumps(function)
        waiting = deque((item, 0) for item in items)
        busy: dict[Any, tuple[Worker, Item, int]] = {}  # by pipe
        try:
            while waiting or busy:
                while waiting and len(busy) < self.jobs:
                    item, lost = waiting.popleft()
                    worker = self._idle.pop() if self._idle else Worker(_Functions)
                    busy[worker.pipe] = worker, item, lost
                    worker.tell("call", pickled, item)
                for pipe in wait(list(busy)):
                    worker, item, lost = busy[pipe]
                    if not worker.ready:
                        worker.started()
                        continue
                    del busy[worker.pipe]
                    try:
                        result = worker.answer()
                    except WorkerDied as death:
                        worker.close()
                        if lost == retries:
                            raise WorkerDied(f"{_short(name(item))}: {death}, {1 + lost} times") from None
                        waiting.appendleft((item, lost + 1))
                        continue
                    except Exception:
                        self._idle.append(worker)
                        raise
                    self._idle.append(worker)
                    yield result
        finally:
            for worker, *_ in busy.values():
                worker.kill()


def process_map(
    function: Callable[[Item], Result], items: Iterable[Item], jobs: int = 0, *, bar: str | None = None,
    unit: str = "item", retries: int = RETRIES, name: Callable[[Item], str] = str,
) -> Iterator[Result]:
    """``function`` of every item over processes: each result as it comes, in any order, each item's exactly once.

    An item whose worker died goes to another one. The first exception that ``function`` raises is raised here, with the
    worker's traceback among its notes; what is left is given up. So it is when the iteration is left.

    Args:
        function: of one item; a module's own function or a `functools.partial` of one, since it is pickled.
        items: plain data. Put into each what its result needs to be told from the others'.
        jobs: processes, at most one an item; 0 for one a core, 1 for this process alone.
        bar: name of a progress bar on standard error; none by default.
        unit: what the bar counts.
        retries: times that an item is tried again after its worker died.
        name: what to call an item in an error.

    Raises:
        WorkerDied: (a SimulationError) an item's workers have died ``1 + retries`` times, or none started.
        InputError: jobs is no whole number, 0 or more.
    """
    listed = list(items)
    with Pool(min(Pool(jobs).jobs, max(1, len(listed)))) as pool:
        yield from pool.map(function, listed, bar=bar, unit=unit, retries=retries, name=name)


def _here(function: Callable[[Item], Result], items: list[Item]) -> Iterator[Result]:
    for item in items:
        yield function(item)


def _with_bar(results: Iterator[Result], total: int, bar: str, unit: str) -> Iterator[Result]:
    with progress_bar(total=total, desc=bar, unit=unit) as shown:
        for result in results:
            shown.update()
            yield result


def _short(text: str) -> str:
    return text if len(text) <= 100 else text[:97] + "..."


class _Functions:
    """The object of a pool's worker."""

    def call(self, pickled: bytes, item: Any) -> Any:
        return _unpickled(pickled)(item)


@lru_cache(maxsize=1)
def _unpickled(function: bytes) -> Callable[[Any], Any]:
    return pickle.loads(function)
