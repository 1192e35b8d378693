"""Ray's workers on a local cluster of two workers; needs the extra `cluster`."""

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest
from workers import killed_once

from tensegym.processes import Pool
from tensegym.search.loop import run_search
from tensegym.search.store import Store
from tensegym.search.workers import open_workers

if importlib.util.find_spec("ray") is None:
    pytest.skip("needs ray", allow_module_level=True)
psutil = pytest.importorskip("psutil")


def listening() -> set[str]:
    """Addresses at which this process and those it started listen."""
    process = psutil.Process()
    return {
        connection.laddr.ip.removeprefix("::ffff:")
        for each in (process, *process.children(recursive=True))
        for connection in each.net_connections("tcp")
        if connection.status == psutil.CONN_LISTEN
    }


def test_ray_finds_what_local_processes_find_and_retries_a_killed_worker(tiny, tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parent), prepend=os.pathsep)
    problem = tiny()
    kept = {}
    with open_workers("ray", 2) as ray:
        assert listening() <= {"127.0.0.1"}
        for name, pool in (("ray", ray), ("local", Pool(1))):
            (tmp_path / name).mkdir()
            run_search(problem, store := Store(tmp_path / name, problem), pool, 4)
            kept[name] = {n: (values, o.metrics) for n, (values, o) in store.finished().items()}
        killed = tiny()
        killed.space.tables["controller"]["policy"] = str(tmp_path / "killed")
        (tmp_path / "again").mkdir()
        run_search(killed, store := Store(tmp_path / "again", killed), ray, 4, evaluate=killed_once)
    assert kept["ray"] == kept["local"]
    assert (tmp_path / "killed").exists()
    assert sorted(store.finished()) == [0, 1, 2, 3]


STRANGER = """
import os, sys
os.environ["RAY_AUTH_TOKEN"] = "guess"
import ray
ray.init(address=sys.argv[1], logging_level="error")
"""


def test_ray_started_here_takes_no_one_without_its_token():
    with open_workers("ray", 1) as started:
        address = started._ray.get_runtime_context().gcs_address
        done = subprocess.run([sys.executable, "-c", STRANGER, address], capture_output=True, text=True, timeout=120)
    assert done.returncode != 0
    assert "uthentic" in done.stderr
