"""`make fuzz`: damaged input for every reader and the environment, counted.

A process of its own for each, so that a crash or a hang of one is seen and does not end the others. What was foreign is
printed with its place, and the first input of each kind is kept in the output folder.
"""

import argparse
import faulthandler
import json
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, Phase, given, seed, settings

from tests.fuzz.judge import NAMES, Foreign, trial
from tests.fuzz.readers import READERS

SLOW = {"study": 8, "storage": 4, "gym.make": 2, "command lines": 2}  # as many times fewer inputs
PATIENCE = 120  # s; no valid input takes as long, on a busy machine either
MEMORY = 12 << 30  # bytes of address space


def work(name: str, count: int, first: int, out: Path) -> None:
    """Judge ``count`` inputs of one reader; prints its figures as JSON."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    warnings.simplefilter("ignore")
    figures = {"inputs": 0, "refused": 0, "accepted": 0}
    foreign: dict[str, int] = {}
    folder = Path(tempfile.mkdtemp())
    inputs, judge = trial(name, folder)
    for content in READERS[name].sources() if name in READERS else ():  # kernels compile now, where no one waits
        judge(content)

    @seed(first)
    @settings(max_examples=count, deadline=None, database=None, phases=[Phase.generate],
              suppress_health_check=list(HealthCheck))
    @given(inputs)
    def run(given_input: object) -> None:
        figures["inputs"] += 1
        content = given_input if isinstance(given_input, bytes) else repr(given_input).encode()
        (out / f"{name}.last").write_bytes(content)
        faulthandler.dump_traceback_later(PATIENCE, exit=True)
        try:
            figures["accepted" if judge(given_input) else "refused"] += 1
        except Foreign as error:
            if error.kind not in foreign:
                shutil.copy(out / f"{name}.last", out / f"{name}-{len(foreign)}")
                print(f"{name}: {error} [{name}-{len(foreign)}]", file=sys.stderr, flush=True)
            foreign[error.kind] = foreign.get(error.kind, 0) + 1
        finally:
            faulthandler.cancel_dump_traceback_later()

    run()
    shutil.rmtree(folder)
    print(json.dumps(figures | {"foreign": foreign}))


def watched(name: str, count: int, first: int, out: Path) -> dict[str, Any]:
    """The figures of a reader's process, or how it ended."""
    count //= SLOW.get(name, 1)
    command = [sys.executable, "-m", "tests.fuzz", "--reader", name, "--inputs", str(count), "--seed", str(first),
               "--out", str(out)]  # fmt: skip
    begun = time.monotonic()
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    lines = done.stdout.strip().splitlines()
    figures: dict[str, Any] = {"inputs": 0, "refused": 0, "accepted": 0, "foreign": {}}
    if done.returncode == 0 and lines:
        figures = json.loads(lines[-1])
    else:
        figures["ended"] = f"status {done.returncode}, see {name}.last"
    return figures | {"reader": name, "seconds": round(time.monotonic() - begun)}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--inputs", type=int, default=900, help="of each reader, fewer of the slow ones")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--reader", choices=NAMES, help="this one alone, in this process")
    parser.add_argument("--out", type=Path, default=Path("runs/fuzz"), help="folder for inputs that found something")
    given_arguments = parser.parse_args()
    given_arguments.out.mkdir(parents=True, exist_ok=True)
    if given_arguments.reader:
        work(given_arguments.reader, given_arguments.inputs, given_arguments.seed, given_arguments.out)
        return 0
    with ThreadPoolExecutor(given_arguments.jobs) as pool:
        rows = list(pool.map(
            lambda name: watched(name, given_arguments.inputs, given_arguments.seed, given_arguments.out), NAMES))
    print(f"{'reader':13} {'inputs':>7} {'refused':>8} {'accepted':>9} {'foreign':>8} {'hung or died':>13} {'s':>5}")
    for row in rows:
        count = sum(row["foreign"].values())
        print(f"{row['reader']:13} {row['inputs']:7} {row['refused']:8} {row['accepted']:9} {count:8} "
              f"{'ended' in row:13} {row['seconds']:5}" + (f"  {row['ended']}" if "ended" in row else ""))  # fmt: skip
    inputs, foreign = sum(r["inputs"] for r in rows), sum(sum(r["foreign"].values()) for r in rows)
    hung = sum("ended" in row for row in rows)
    print(f"{inputs} inputs, {foreign} foreign exceptions, {hung} hung or died")
    return 1 if foreign or hung else 0


if __name__ == "__main__":
    sys.exit(main())
