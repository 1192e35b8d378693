"""Commands that are ended from outside: the status a shell expects, whole files, no process left."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tensegym.cli import main

COMMAND = [sys.executable, "-c", "from tensegym.cli.main import main; main()"]
TASK = """
[task]
motion = "roll"
seconds = 600.0
[controller]
amplitudes = [0.5, 0.5]
[space]
"controller.lags" = {low = -1.0, high = 1.0}
"""


def processes(session):
    """Processes of a session that are not over."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, own = stat.read_text().rsplit(")", 1)[1].split()[:4]
        except OSError:
            continue
        if int(own) == session and state != "Z":
            found.append(int(stat.parent.name))
    return found


def wait_for(condition):
    deadline = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.05)


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")
@pytest.mark.parametrize(("how", "status"), [(signal.SIGTERM, 143), (signal.SIGINT, 130), (signal.SIGKILL, -9)])
def test_a_search_that_is_ended_leaves_no_process_and_blocks_no_other(tmp_path, how, status):
    (tmp_path / "task.toml").write_text(TASK)
    argv = [*COMMAND, "design", "run", "--task", "task.toml", "--jobs", "2", "--out", "out"]
    first = subprocess.Popen(argv, cwd=tmp_path, stderr=subprocess.PIPE, text=True, start_new_session=True)
    wait_for(lambda: (tmp_path / "out" / "storage.txt").exists() and len(processes(first.pid)) >= 4)

    second = subprocess.run(argv, cwd=tmp_path, capture_output=True, text=True)
    assert second.returncode == 2
    assert f"out is in use by `-c design run`, process {first.pid} on" in second.stderr

    if how == signal.SIGINT:
        os.killpg(first.pid, how)  # as a terminal does
    else:
        first.send_signal(how)
    assert first.wait(60) == status
    assert "Traceback" not in first.stderr.read()
    wait_for(lambda: not processes(first.pid))
    status = subprocess.run([*COMMAND, "design", "status", "--folder", "out", "--json"], cwd=tmp_path,
                            capture_output=True, text=True)  # fmt: skip
    assert json.loads(status.stdout)["trials"] == 0
    left = {path.name for path in (tmp_path / "out").iterdir()} - {"storage.txt", "study.db", "study.db-wal",
                                                                  "study.db-shm"}  # fmt: skip
    assert left <= ({".tensegym-lock"} if how == signal.SIGKILL else set())


SWALLOWS = """
import ctypes, os, signal, sys, time
from tensegym.cli import main

def callback():
    os.kill(os.getpid(), {how})
    for _ in range(1000):
        pass

def run(words):
    ctypes.CFUNCTYPE(None)(callback)()
    print("swallowed", flush=True)
    time.sleep(60)
    return 0

main.run = run
main.main()
"""


@pytest.mark.parametrize(("how", "status"), [(signal.SIGTERM, 143), (signal.SIGINT, 130)])
def test_a_signal_that_a_librarys_callback_swallows_ends_the_command_all_the_same(how, status):
    """As where the compiler calls back."""
    done = subprocess.run([sys.executable, "-c", SWALLOWS.format(how=int(how))], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (status, "swallowed\n", "")


@pytest.mark.parametrize("wrapped", [SystemError, ImportError])  # of a call of compiled code, of a library's start
@pytest.mark.parametrize(("how", "status"), [(KeyboardInterrupt, 130), (main._Terminated, 143)])
def test_an_interrupt_that_compiled_code_wraps_ends_the_command_as_any(monkeypatch, how, status, wrapped):
    def interrupted(_):
        raise wrapped("CPUDispatcher returned a result with an exception set") from how()

    monkeypatch.setattr(main, "run", interrupted)
    monkeypatch.setattr(main.signal, "signal", lambda *_: None)
    with pytest.raises(SystemExit) as ended:
        main.main()
    assert ended.value.code == status
