"""Trials and their summary, on rows made by hand and on a tiny policy."""

import json
import os

import imageio.v3 as imageio
import numpy as np
import pytest

from tensegym.errors import InputError, SimulationError
from tensegym.report import Report
from tensegym.train.controllers import Controller, load_policy, policy_controller
from tensegym.train.evaluate import Evaluate, Roll
from tensegym.train.trials import run_trials, summarise
from tests.conftest import assert_refused


def row(speed, *, passed=True, terminated=False, cost=10.0):
    return {"speed_lps": speed, "speed": 0.7 * speed, "slip_share": speed / 2, "slip_share_sum": speed, "tips": 4,
            "cost_of_transport": cost, "audit_passed": passed, "audit_excess": 0.0 if passed else 0.02,
            "terminated": terminated}  # fmt: skip


def test_summary_of_rows_made_by_hand():
    summary = summarise([row(s) for s in (0.1, 0.2, 0.3, 0.4, 1.0)])
    assert summary["episodes"] == 5
    assert summary["speed_lps_median"] == pytest.approx(0.3)
    assert summary["speed_lps_mean"] == pytest.approx(0.4)
    deviation = np.sqrt((0.09 + 0.04 + 0.01 + 0 + 0.36) / 4)
    half = 1.96 * deviation / np.sqrt(5)
    assert summary["speed_lps_mean_ci95"] == pytest.approx([0.4 - half, 0.4 + half])
    assert summary["share_over_half_median"] == pytest.approx(0.8)
    assert summary["slip_share_median"] == pytest.approx(0.15)
    assert summary["slip_share_sum_median"] == pytest.approx(0.3)
    assert summary["speed_mps_median"] == pytest.approx(0.21)
    assert (summary["audit_failures"], summary["terminated"]) == (0, 0)


def test_the_way_of_a_trial_that_fails_the_audit_or_diverges_does_not_count():
    rows = [row(0.2), row(0.3), row(9.0, passed=False), row(8.0, terminated=True)]
    summary = summarise(rows)
    assert summary["speed_lps_median"] == pytest.approx(0.1)  # of 0, 0, 0.2, 0.3
    assert summary["speed_lps_mean"] == pytest.approx(0.125)
    assert summary["speed_mps_median"] == pytest.approx(0.07)
    assert summary["audit_failures"] == 1
    assert summary["terminated"] == 1
    assert summary["audit_excess_max"] == 0.02


def test_one_trial_has_no_interval_and_standing_still_has_no_cost():
    summary = summarise([row(0.0, cost=None)])
    assert summary["speed_lps_mean_ci95"] is None
    assert summary["cost_of_transport_median"] is None
    json.dumps(summary, allow_nan=False)


def test_trials_are_the_same_over_one_process_and_two(tiny_run):
    policy = policy_controller(str(tiny_run))
    one = run_trials(policy, [3, 1, 2], seconds=2.0, jobs=1, quiet=True)
    two = run_trials(policy, [3, 1, 2], seconds=2.0, jobs=2, quiet=True)
    assert one == two
    assert [r["seed"] for r in one] == [3, 1, 2]
    assert len({r["path"] for r in one}) == 3


def test_random_commands_repeat_by_seed_whatever_ran_before():
    controller = Controller("random", "random", None, {})
    alone = run_trials(controller, [5], seconds=2.0, jobs=1, quiet=True)
    after = run_trials(controller, [4, 5], seconds=2.0, jobs=1, quiet=True)
    assert after[1] == alone[0]
    assert after[0]["path"] != after[1]["path"]


def test_what_fails_in_a_worker_is_raised_here(tmp_path):
    with pytest.raises(FileNotFoundError, match="no table of tips"):
        run_trials(Controller("walker", "walker", str(tmp_path / "none.json"), {}), [1, 2], jobs=2, quiet=True)


class Quits(Controller):
    def start(self, env):
        os._exit(3)


def test_a_worker_that_dies_is_an_error_not_a_wait_for_ever():
    with pytest.raises(SimulationError, match="a trial process ended with status 3"):
        run_trials(Quits("policy", "quits", None, {}), [1, 2], jobs=2, quiet=True)


def test_evaluate_writes_metrics_picture_video_and_table(tiny_run, tmp_path, cli):
    out = tmp_path / "evaluation"
    status, text, _ = cli("evaluate", "--policy", tiny_run, "--out", out, "--episodes", 2, "--seconds", 2, "--jobs", 1,
                          "--no-baselines")  # fmt: skip
    assert status == 0
    assert sorted(p.name for p in out.iterdir()) == ["gait.png", "metrics.json", "roll.mp4"]

    metrics = json.loads((out / "metrics.json").read_text())
    assert metrics["dt"] == 0.002
    names = [str(tiny_run), f"{tiny_run}, half time step"]
    assert list(metrics["summaries"]) == list(metrics["episodes"]) == names
    for name in names:
        rows = metrics["episodes"][name]
        assert [r["seed"] for r in rows] == [10_000, 10_001]
        assert all(r["duration"] == pytest.approx(2.0) for r in rows)
        median = np.median([r["speed_lps"] for r in rows])
        assert metrics["summaries"][name]["speed_lps_median"] == pytest.approx(median)
        assert name in text
    assert "median L/s" in text and "audit failures" in text

    picture = imageio.imread(out / "gait.png")
    assert picture.shape[0] > 500 and picture.std() > 10
    frames = imageio.imread(out / "roll.mp4", plugin="FFMPEG")
    assert frames.shape[0] == pytest.approx(40, abs=2)  # 2 s at 20 a second
    assert np.abs(frames[0].astype(float) - frames[-1]).max() > 50


def test_one_episode_with_baselines_as_json(tiny_run, tmp_path, cli, monkeypatch):
    from tensegym.control.tipping import Pull, Tip
    from tensegym.control.walker import save_table

    save_table([Tip(Pull((0, 1), 0.3), face, (face + 1) % 20, (0.1, 0.0), 10.0) for face in range(20)],
               tmp_path / "tips.json")  # fmt: skip
    monkeypatch.setattr("tensegym.train.evaluate.shipped_table", lambda: str(tmp_path / "tips.json"))
    status, text, _ = cli("evaluate", "--policy", tiny_run, "--out", tmp_path / "e", "--episodes", 1, "--seconds", 1,
                          "--jobs", 1, "--no-half-step", "--no-video", "--json")  # fmt: skip
    assert status == 0
    data = json.loads(text)
    assert list(data["summaries"]) == [str(tiny_run), "open-loop walker", "random commands"]
    assert data["summaries"]["random commands"]["speed_lps_mean_ci95"] is None
    assert sorted(p.name for p in (tmp_path / "e").iterdir()) == ["gait.png", "metrics.json"]


def test_the_policy_acts_on_normalised_observations_and_repeats(tiny_run):
    from tensegym.envs.rolling import RollingEnv

    with RollingEnv(observation="onboard") as env:
        act = load_policy(tiny_run, env)
        observation, _ = env.reset(seed=0)
        np.testing.assert_array_equal(act(observation), act(observation))
        assert np.abs(act(observation) - act(observation + 0.5)).max() > 0
        assert act(observation) in env.action_space


def test_a_policy_for_another_observation_is_refused(tiny_run, tmp_path, cli):
    from tensegym.envs.rolling import RollingEnv

    with RollingEnv() as env, pytest.raises(InputError, match=r"observations of shape \(54,\), here they are \(132,\)"):
        load_policy(tiny_run, env)
    out = tmp_path / "e"
    assert_refused(cli("evaluate", "--policy", tiny_run, "--observation", "full", "--out", out), "(54,)", "(132,)")
    assert not out.exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--policy", "walking"], ["no policy in 'walking'", "model.zip"]),
        (["--episodes", "0"], ["episodes = 0"]),
        (["--seconds", "0.5"], ["seconds = 0.5", "[1, 3600]"]),
        (["--seconds", "nan"], ["seconds = nan"]),
        (["--dt", "0"], ["dt = 0"]),
        (["--dt", "0.003"], ["control_period = 0.4", "0.003"]),
        (["--observation", "camera"], ["observation = 'camera'", "full, onboard"]),
    ],
)
def test_bad_arguments_of_evaluate_write_nothing(arguments, words, tiny_run, tmp_path, cli):
    out = tmp_path / "e"
    policy = [] if "--policy" in arguments else ["--policy", tiny_run]
    assert_refused(cli("evaluate", *policy, *arguments, "--out", out), *words)
    assert not out.exists()


def test_a_file_for_a_folder_is_refused(tiny_run, tmp_path, cli):
    (tmp_path / "e").write_text("mine")
    assert_refused(cli("evaluate", "--policy", tiny_run, "--out", tmp_path / "e"), "is a file")
    assert (tmp_path / "e").read_text() == "mine"


def test_watching_in_a_window_without_a_display_is_refused(tiny_run, tmp_path, cli, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.chdir(tmp_path)
    assert_refused(cli("roll", "--policy", tiny_run, "--window"), "no display")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("policy", "plain"), [("rolling", True), ("climb", True), ("carry", False)])
def test_roll_judges_baselines_on_the_default_robot_only(policy, plain, monkeypatch):
    # another robot's walker would take minutes to tabulate, and roll is a quick look
    monkeypatch.setattr(Evaluate, "run", lambda self: Report("", {"baselines": self.baselines}))
    assert Roll(policy).run().data["baselines"] is plain
