"""What a viewer costs: updates of the scene a second at real time, and how much slower the simulation runs.

    python benchmarks/view.py [--rounds 5] [--seconds 4] [--out benchmarks/results/view.json]

Three things, one after another in each round, of the default robot rolled by the open-loop walker:

* alone: a session in its process, as fast as it goes, nothing drawn;
* drawn: the same under a page that shows it thirty times a second, with a viewer connected that reads every message but
  draws nothing (a browser without a GPU would take the cores that the simulation is measured on);
* real time: the page at speed 1: how often the scene changed a second, and the robot's time over the clock's.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median

import viser
from websockets.sync.client import connect

from tensegym.files import write_json
from tensegym.processes import Worker
from tensegym.report import table
from tensegym.view.choice import Choice
from tensegym.view.live import Live
from tensegym.view.page import Page
from tensegym.view.session import Session

WALKER = Choice("walker")


def alone(seconds: float) -> float:
    """Robot's seconds a second, nothing drawn."""
    worker = Worker(Session, WALKER)
    worker.started()
    worker.tell("run", 0.5)
    before = worker.answer()[-1].time
    worker.tell("run", seconds)
    rate = (worker.answer()[-1].time - before) / seconds
    worker.close()
    return rate


@contextmanager
def shown() -> Iterator[Live]:
    """The walker in a page that a viewer is connected to."""
    with Page("tensegym", port=0) as page:
        live = Live(page, WALKER)
        address = page.url.replace("http", "ws")
        with connect(address, subprotocols=[f"viser-v{viser.__version__}"], max_size=None, compression=None) as viewer:
            threading.Thread(target=lambda: [None for _ in viewer], daemon=True).start()
            threading.Thread(target=live.run, daemon=True).start()
            yield live
            live.end()


def watched(live: Live, seconds: float) -> tuple[float, float]:
    """Robot's seconds a second, and updates of the scene a second."""
    time.sleep(0.5)
    start, time_before, shown_before = time.perf_counter(), live.frame.time, live.shown
    time.sleep(seconds)
    passed = time.perf_counter() - start
    return (live.frame.time - time_before) / passed, (live.shown - shown_before) / passed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    rows = []
    for _ in range(given.rounds):
        free = alone(given.seconds)
        with shown() as live:
            live.controls.speed = float("inf")
            drawn, drawn_updates = watched(live, given.seconds)
            live.controls.speed = 1.0
            real, updates = watched(live, given.seconds)
        rows.append([free, drawn, drawn / free, drawn_updates, real, updates])
    header = ["alone [s/s]", "drawn [s/s]", "drawn / alone", "updates/s at most", "real time [s/s]", "updates/s"]
    middle = [median(column) for column in zip(*rows, strict=True)]
    print(table(["", *header], [*([f"round {n}", *row] for n, row in enumerate(rows, 1)), ["median", *middle]]))
    if given.out:
        write_json(given.out, {"columns": header, "rounds": rows, "median": middle})


if __name__ == "__main__":
    main()
