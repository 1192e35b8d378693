"""The Ray engine on a local cluster of two workers; needs the extra `cluster`."""

from pathlib import Path

import pytest
from workers import killed_once

from tensegym.search.engine import JoblibEngine, engine
from tensegym.search.loop import run_search
from tensegym.search.store import Store

pytest.importorskip("ray")


def test_ray_finds_what_joblib_finds_and_retries_a_killed_worker(tiny, tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parent))
    problem = tiny()
    kept = {}
    with engine("ray", 2) as ray:
        for name, pool in (("ray", ray), ("joblib", JoblibEngine(1))):
            (tmp_path / name).mkdir()
            run_search(problem, store := Store(tmp_path / name, problem), pool, 4)
            kept[name] = {n: (values, o.metrics) for n, (values, o) in store.finished().items()}
        killed = tiny()
        killed.space.tables["controller"]["policy"] = str(tmp_path / "killed")
        (tmp_path / "again").mkdir()
        run_search(killed, store := Store(tmp_path / "again", killed), ray, 4, evaluate=killed_once)
    assert kept["ray"] == kept["joblib"]
    assert (tmp_path / "killed").exists()
    assert sorted(store.finished()) == [0, 1, 2, 3]
