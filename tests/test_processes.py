"""The process map and its workers: every item once, whoever dies."""

import os
import pickle
import signal
import subprocess
import sys
import textwrap
import time
from collections import Counter
from functools import partial
from pathlib import Path

import pytest

from tensegym.errors import DesignError, InputError, SimulationError
from tensegym.processes import Pool, Worker, WorkerDied, call_all, cores, process_map
from tests.test_progress import Terminal


def square(item):
    return item, item**2


def refuses_three(item):
    if item == 3:
        raise DesignError("three is none")
    return item


class Awkward(Exception):
    """Does not come back out of a pickle."""

    def __init__(self, one, two):
        super().__init__(f"{one} and {two}")


def awkward(item):
    raise Awkward(item, "more")


def dies_once(folder, item):
    """Killed at its first try of every third item; leaves a mark a try that ended well."""
    mark = Path(folder) / f"killed-{item}"
    if item % 3 == 0 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return item


def dies(item):
    os._exit(3)


def asks_cores(item):
    return cores()


class Counts:
    def __init__(self, first):
        if first < 0:
            raise DesignError("below 0")
        self.value = first

    def add(self, by):
        self.value += by
        return self.value

    def fail(self, text):
        raise DesignError(text)

    def end(self):
        os._exit(0)


@pytest.mark.parametrize("jobs", [0, 1, 2, 3])
def test_every_item_gives_one_result_from_any_number_of_processes(jobs):
    assert sorted(process_map(square, range(20), jobs)) == [(i, i**2) for i in range(20)]


def test_no_items_give_nothing():
    assert list(process_map(square, [], 2)) == []


def test_items_of_workers_that_were_killed_are_done_again_and_none_twice(tmp_path):
    results = Counter(process_map(partial(dies_once, str(tmp_path)), range(12), 2))
    assert results == Counter(range(12))
    assert len(list(tmp_path.iterdir())) == 4


def test_an_item_that_always_ends_its_worker_is_named():
    with pytest.raises(SimulationError, match="trial 7: a worker process has died, ended with status 3, 2 times"):
        list(process_map(dies, [7, 7], 2, retries=1, name=lambda item: f"trial {item}"))


@pytest.mark.parametrize("jobs", [1, 2])
def test_what_the_function_raises_is_raised_here_and_the_pool_goes_on(jobs):
    with Pool(jobs) as pool:
        with pytest.raises(DesignError, match="three is none"):
            list(pool.map(refuses_three, range(20)))
        assert sorted(pool.map(square, range(9))) == [(i, i**2) for i in range(9)]


def test_the_workers_own_traceback_comes_along():
    with Pool(2) as pool, pytest.raises(DesignError) as caught:
        list(pool.map(refuses_three, range(5)))
    assert "in refuses_three" in caught.value.__notes__[0]


def test_an_exception_that_does_not_pickle_is_told_by_its_text():
    with Pool(2) as pool, pytest.raises(SimulationError, match="Awkward in a worker process: 1 and more"):
        list(pool.map(awkward, [1]))


def test_leaving_the_map_ends_what_it_was_at_work_on():
    with Pool(2) as pool:
        results = pool.map(time.sleep, [0.0, 600.0])
        next(results)
        results.close()
        assert sorted(pool.map(square, range(3))) == [(0, 0), (1, 1), (2, 4)]


@pytest.mark.parametrize("jobs", [-1, True, 1.5, "2"])
def test_numbers_of_jobs_that_are_none_are_refused(jobs):
    with pytest.raises(InputError, match=r"jobs = .* must be a whole number"):
        list(process_map(square, range(3), jobs))


def test_a_worker_counts_one_core_as_its_own():
    with Pool(2) as pool:
        assert list(pool.map(asks_cores, range(3))) == [1, 1, 1]


def test_the_bar_shows_on_a_terminal(monkeypatch):
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert len(list(process_map(square, range(4), 2, bar="squares", unit="square"))) == 4
    assert "squares: 100%" in sys.stderr.getvalue()


@pytest.fixture
def two():
    workers = [Worker(Counts, 10), Worker(Counts, 20)]
    yield workers
    for worker in workers:
        worker.close()
    assert not any(worker.process.is_alive() for worker in workers)


def test_workers_keep_their_state_and_answer_in_turn(two):
    assert call_all(two, "add", [(1,), (2,)]) == [11, 22]
    with pytest.raises(DesignError, match="no"):
        call_all(two, "fail", [("no",), ("neither",)])
    with pytest.raises((AttributeError, pickle.PicklingError)):
        call_all(two, "add", [(1,), (lambda: 0,)])  # is not sent at all
    assert call_all(two, "add", [(1,), (2,)]) == [12, 24]


def test_a_worker_whose_object_cannot_be_made_says_why():
    worker = Worker(Counts, -1)
    with pytest.raises(DesignError, match="below 0"):
        worker.started()
    worker.close()


def test_a_worker_that_ends_is_noticed(two):
    with pytest.raises(WorkerDied, match="ended with status 0"):
        call_all(two, "end", [(), ()])


PARENT = """
    import os, sys, time
    from tensegym.processes import Pool, Worker

    class Idle:
        pass

    def work(item):
        print(os.getpid(), flush=True)
        if item % 2:
            time.sleep(600)
        while True:
            pass

    if __name__ == "__main__":
        idle = Worker(Idle)
        idle.started()
        print(idle.process.pid, flush=True)
        with Pool(2) as pool:
            list(pool.map(work, range(2)))
"""


def gone(pid):
    """Whether a process has ended; a child that waits for its parent to look at it has."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"
    except OSError:
        return True


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_workers_end_with_the_process_that_started_them(tmp_path, how):
    script = tmp_path / "parent.py"
    script.write_text(textwrap.dedent(PARENT))
    with subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          start_new_session=True) as parent:  # fmt: skip
        workers = [int(parent.stdout.readline()) for _ in range(3)]
        assert not any(gone(worker) for worker in workers)
        if how == signal.SIGINT:
            os.killpg(parent.pid, how)  # as a terminal does
        else:
            parent.send_signal(how)
        parent.wait(30)
        deadline = time.monotonic() + 30
        while not all(gone(worker) for worker in workers) and time.monotonic() < deadline:
            time.sleep(0.05)
        assert all(gone(worker) for worker in workers)
        assert parent.stderr.read().count("Traceback") == (1 if how == signal.SIGINT else 0)
