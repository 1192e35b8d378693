"""A worker: a process that makes one object and calls its methods when told.

It ignores Ctrl-C, which is for the process that tells it. It ends when its pipe does, and in the middle of its work
when the process that started it has ended, killed or not.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import threading
import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, wait
from typing import Any

from tensegym.errors import SimulationError

_PATIENCE = 5.0  # s, for a worker that was told to end
_CONTEXT: Any = multiprocessing.get_context("forkserver" if hasattr(os, "fork") else "spawn")


class WorkerDied(SimulationError):
    """A worker process ended without an answer."""


def cores() -> int:
    """Cores this process may run on; 1 in a worker, whose siblings have the others."""
    if multiprocessing.current_process().daemon:
        return 1
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Worker:
    """A process with the object that ``make(*arguments)`` returns. What is told is answered in turn.

    Starting takes a while and is not waited for; `started` does so.
    """

    def __init__(self, make: Callable[..., Any], *arguments: Any) -> None:
        self.pipe, theirs = _CONTEXT.Pipe()
        self.process = _CONTEXT.Process(target=_serve, args=(theirs,), daemon=True)
        with _no_interrupt():
            self.process.start()
        theirs.close()
        self._ready = False
        self._send(pickle.dumps((make, arguments)))

    def started(self) -> None:
        """Wait until the object is made. Raises what making it raised, and WorkerDied."""
        if not self._ready:
            self._answer()
            self._ready = True

    @property
    def ready(self) -> bool:
        """Whether `started` has returned."""
        return self._ready

    def tell(self, method: str, *arguments: Any) -> None:
        """Call a method of the object; the next `answer` is what it returns."""
        self._send(pickle.dumps((method, arguments)))

    def answer(self) -> Any:
        """What the call told returned. Raises what it raised, and WorkerDied."""
        self.started()
        return self._answer()

    def _send(self, message: bytes) -> None:
        with suppress(OSError):  # a dead worker is seen where its answer is missed
            self.pipe.send_bytes(message)

    def _answer(self) -> Any:
        try:
            fine, value = self.pipe.recv()
        except (EOFError, OSError):
            raise WorkerDied(f"a worker process {self._end()}") from None
        if not fine:
            raise value
        return value

    def _end(self) -> str:
        if not self._ready:
            return ('did not start; a script starts workers under `if __name__ == "__main__":`, '
                    "or does with one process")  # fmt: skip
        self.process.join(_PATIENCE)
        code = self.process.exitcode or 0
        return f"has died, killed by signal {-code}" if code < 0 else f"has died, ended with status {code}"

    def kill(self) -> None:
        """End the process at once, whatever it is doing."""
        self.process.kill()
        self.close()

    def close(self) -> None:
        """End the process as soon as it is idle; kill it when that takes long."""
        self.pipe.close()
        self.process.join(_PATIENCE)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()


def call_all(workers: Sequence[Worker], method: str, arguments: Iterable[Sequence[Any]]) -> list[Any]:
    """Call a method of every worker's object at a time, each with its arguments; the answers in the workers' order.

    All answers are taken before an error among them is raised, so that the workers stay in turn. Where that cannot be,
    as at a Ctrl-C in between, all are killed. Raises what a worker raised, and WorkerDied.
    """
    messages = [pickle.dumps((method, tuple(own))) for own in arguments]
    errors, answers = [], []
    try:
        for worker, message in zip(workers, messages, strict=True):
            worker._send(message)
        for worker in workers:
            try:
                answers.append(worker.answer())
            except Exception as error:
                errors.append(error)
    except BaseException:
        for worker in workers:
            worker.kill()
        raise
    if errors:
        raise errors[0]
    return answers


@contextmanager
def _no_interrupt() -> Iterator[None]:
    """Hold Ctrl-C back, here and in the processes that are started, which let it through when they ignore it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _serve(pipe: Connection) -> None:
    """What a worker runs: the first message makes its object, the others call its methods."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    served: Any = None
    while True:
        try:
            message = pipe.recv_bytes()
        except (EOFError, OSError):
            return
        try:
            what, arguments = pickle.loads(message)
            if isinstance(what, str):
                value = getattr(served, what)(*arguments)
            else:
                served, value = what(*arguments), None
            answer = pickle.dumps((True, value))
        except Exception as error:
            answer = _failure(error)
        try:
            pipe.send_bytes(answer)
        except OSError:
            return


def _failure(error: Exception) -> bytes:
    """The answer that carries an exception over, or its text where it does not pickle."""
    text = "".join(traceback.format_exception(error))
    try:
        error.add_note(f"in a worker process:\n{text}")
        answer = pickle.dumps((False, error))
        pickle.loads(answer)
    except Exception:
        answer = pickle.dumps((False, SimulationError(f"{type(error).__name__} in a worker process: {error}")))
    return answer


def _end_with_parent() -> None:
    """Wait for the end of the process that started this one, seen by a pipe that only that one holds; end with it.

    The operating system's own signal at a parent's death (prctl) names the wrong one: the server that forks workers.
    """
    parent = multiprocessing.parent_process()
    assert parent is not None
    wait([parent.sentinel])
    os._exit(1)
