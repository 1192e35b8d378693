import json
import os
import signal
import subprocess
import sys
import time
import tomllib

import pytest
import tomli_w

from tensegym.search.problem import problem_from
from tensegym.search.store import Store
from tests.conftest import assert_refused


def design(cli, *argv):
    status, out, err = cli("design", *argv, "--json")
    assert status == 0, err
    return json.loads(out)


def test_run_status_resume_report(cli, tiny_file, tmp_path):
    out = tmp_path / "study"
    data = design(cli, "run", "--task", tiny_file, "--budget", 3, "--out", out)
    assert data["trials"] == data["budget"] == 3
    assert design(cli, "status", "--folder", out)["best_trial"] == data["best_trial"]
    assert design(cli, "resume", "--folder", out, "--budget", 4)["trials"] == 4
    report = design(cli, "report", "--folder", out, "--episodes", 2, "--against", out)
    assert set(report["confirmed"]) == {"start, 2 ms", "start, 1 ms", "found, 2 ms", "found, 1 ms"}
    found = report["confirmed"]["found, 2 ms"]
    assert found["goal_metric_mean"] == pytest.approx(found["speed_lps_mean"], abs=0)  # the goal is one of speed
    text = (out / "report.md").read_text()
    assert report["gains"][0]["text"] in text and " the start's: " in text
    assert "| speed, mean [L/s] |" in text
    assert "speed_lps, mean" not in text  # once is enough
    reached = "reached" if found["goal_metric_mean"] >= 0.2 else "not reached"
    assert f"The goal, speed_lps >= 0.2, is **{reached}**: {found['goal_metric_mean']:.4g} in the mean" in text
    assert "design.elastic_cable.pretension" in text and "![gait" in text
    for name in ("progress.png", "gait.png", "best/design.toml", "best/controller.toml", "best/urdf/payload.urdf"):
        assert (out / name).is_file() == (name != "best/urdf/payload.urdf")
    assert list((out / "best" / "urdf").glob("*.urdf"))
    # what was found is where the next search begins
    found = {name: tomllib.loads((out / "best" / f"{name}.toml").read_text()) for name in ("design", "controller")}
    again = problem_from(tomli_w.dumps(tomllib.loads(tiny_file.read_text()) | found), "again")
    assert again.space.start == pytest.approx(Store(out, None).finished()[report["trial"]][0])


def test_a_killed_search_loses_only_what_was_in_flight(tiny_file, tmp_path):
    out = tmp_path / "study"
    start = [sys.executable, "-c", "from tensegym.cli.main import main; main()", "design"]
    run = subprocess.Popen([*start, "run", "--task", str(tiny_file), "--budget", "500", "--out", str(out)],
                           stderr=subprocess.DEVNULL, env=os.environ | {"PYTHONUNBUFFERED": "1"})  # fmt: skip
    try:
        for _ in range(600):
            time.sleep(0.1)
            if (out / "storage.txt").is_file() and len(before := Store(out, None).finished()) >= 3:
                break
    finally:
        run.send_signal(signal.SIGKILL)
        run.wait()
    before = Store(out, None).finished()
    budget = len(before) + 2
    subprocess.run([*start, "resume", "--folder", str(out), "--budget", str(budget)], check=True, capture_output=True)
    store = Store(out, None)
    after = store.finished()
    assert len(store.study.get_trials()) == len(after) == budget  # none twice
    assert {n: after[n] for n in before} == before


def test_the_folder_of_another_study_is_refused(cli, tiny_file, tmp_path):
    out = tmp_path / "study"
    design(cli, "run", "--task", tiny_file, "--budget", 1, "--out", out)
    assert_refused(cli("design", "run", "--task", "carry", "--budget", 1, "--out", out), "another task file")
    assert_refused(cli("design", "run", "--task", tiny_file, "--seed", 3, "--out", out), "another task file")


def test_a_controller_that_does_not_fit_is_refused_before_anything_is_written(cli, tiny_file, tmp_path):
    out, command = tmp_path / "study", ("design", "run", "--task", tiny_file, "--budget", 1, "--out")
    prism = '[design.structure]\nbuilder = "prism"\n[controller]\nkind = "walker"\ntips = "three_rod_robot"'
    text = tiny_file.read_text().replace("[controller]\namplitudes = [0.5, 0.5]", prism)
    tiny_file.write_text(text.replace('"controller.lags" = {low = -1.0', '"controller.depth" = {low = 0.5'))
    assert_refused(cli(*command, out), "the start of", "6 drives, this one has 0")
    tiny_file.write_text(tiny_file.read_text().replace("three_rod_robot", "nobodys"))
    assert_refused(cli(*command, out), "no table of tips")
    assert not out.exists()


@pytest.mark.parametrize(
    ("old", "new"), [('motion = "roll"', 'motion = "cross"'), ("[search]", '[search]\nobjectives = ["max tips"]')]
)
def test_searches_of_other_tasks_or_objectives_are_not_compared(cli, tiny_file, tmp_path, old, new):
    text = tiny_file.read_text()
    for name, task in (("this", text), ("other", text.replace(old, new))):
        tiny_file.write_text(task)
        design(cli, "run", "--task", tiny_file, "--budget", 1, "--out", tmp_path / name)
    argv = ("design", "report", "--folder", tmp_path / "this", "--episodes", 2, "--against", tmp_path / "other")
    assert_refused(cli(*argv), "other is a search of the task", "max speed_lps; compare")
    assert not (tmp_path / "this" / "report.md").exists()


@pytest.mark.parametrize("url", ["postgresql://nobody@127.0.0.1:1/none", "nonsense", "sqlite:////no/such/folder/a.db"])
def test_a_storage_that_does_not_answer_is_refused(cli, tiny_file, tmp_path, url):
    out = tmp_path / "study"
    result = cli("design", "run", "--task", tiny_file, "--out", out, "--storage", url)
    assert_refused(result, url, "does not answer")
    assert not out.exists()


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (["run", "--task", "nowhere.toml"], ["no task file nowhere.toml", "carry"]),
        (["run", "--budget", "0"], ["budget = 0"]),
        (["run", "--jobs", "0"], ["jobs = 0"]),
        (["run", "--workers", "magic"], ["workers = 'magic'", "local, ray"]),
        (["run", "--engine", "ray"], ["engine = 'ray' is not one of pybullet, mujoco"]),
        (["run", "--address", "127.0.0.1:1"], ["no Ray cluster answers", "127.0.0.1:1"]),
        (["status", "--folder", "nothing"], ["no search in nothing"]),
        (["resume", "--folder", "nothing"], ["no search in nothing"]),
        (["report", "--folder", "nothing"], ["no search in nothing"]),
        (["report", "--episodes", "1"], ["episodes = 1"]),
    ],
)
def test_bad_input(cli, tmp_path, monkeypatch, argv, words):
    monkeypatch.chdir(tmp_path)
    assert_refused(cli("design", *argv), *words)
    assert not list(tmp_path.iterdir())


def test_a_missing_library_is_named_with_the_extra_that_brings_it(cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "ray", None)
    assert_refused(cli("design", "run", "--workers", "ray"), "ray is not installed", "pip install '.[cluster]'")
    assert not list(tmp_path.iterdir())
