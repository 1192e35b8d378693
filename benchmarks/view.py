"""What a viewer costs: updates of the scene a second at real time, and how much slower the simulation runs.

    python benchmarks/view.py [--rounds 5] [--seconds 4] [--out benchmarks/results/view.json]

Three things, one after another in each round, of the default robot rolled by the open-loop walker:

* alone: a session in its process, as fast as it goes, nothing drawn;
* drawn: the same under a page that shows it thirty times a second, with a viewer connected that reads every message but
  draws nothing (a browser without a GPU would take the cores that the simulation is measured on);
* real time: the page at speed 1: how often the scene changed a second, and the robot's time over the clock's.

The first two count the robot's seconds for a second of the clock, and for a second of the processor that the simulating
process was given: on a machine that others use too only the second one says what the page costs.
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


def processor(worker: Worker) -> float:
    """Processor time of a worker so far [s], on Linux."""
    fields = Path(f"/proc/{worker.process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def alone(seconds: float) -> tuple[float, float]:
    """Robot's seconds a second of the clock, and of the processor, nothing drawn."""
    worker = Worker(Session, WALKER)
    worker.started()
    worker.tell("run", 0.5)
    before, start, used = worker.answer()[-1].time, time.perf_counter(), processor(worker)
    worker.tell("run", seconds)
    made = worker.answer()[-1].time - before
    rates = made / (time.perf_counter() - start), made / (processor(worker) - used)
    worker.close()
    return rates


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


def watched(live: Live, seconds: float) -> tuple[float, float, float]:
    """Robot's seconds a second of the clock, and of the processor, and updates of the scene a second."""
    time.sleep(0.5)
    start, time_before, shown_before, used = time.perf_counter(), live.frame.time, live.shown, processor(live.worker)
    time.sleep(seconds)
    passed, made = time.perf_counter() - start, live.frame.time - time_before
    return made / passed, made / (processor(live.worker) - used), (live.shown - shown_before) / passed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    rows = []
    for _ in range(given.rounds):
        free, free_used = alone(given.seconds)
        with shown() as live:
            live.controls.speed = float("inf")
            drawn, drawn_used, _ = watched(live, given.seconds)
            live.controls.speed = 1.0
            real, _, updates = watched(live, given.seconds)
        rows.append([free, drawn, drawn / free, free_used, drawn_used, drawn_used / free_used, real, updates])
    header = ["alone, clock", "drawn, clock", "ratio", "alone, processor", "drawn, processor", "ratio ", "real time",
              "updates/s"]  # fmt: skip
    middle = [median(column) for column in zip(*rows, strict=True)]
    print(table(["", *header], [*([f"round {n}", *row] for n, row in enumerate(rows, 1)), ["median", *middle]]))
    if given.out:
        write_json(given.out, {"columns": header, "rounds": rows, "median": middle})


if __name__ == "__main__":
    main()
