"""Trials and their summary, on rows made by hand and on a tiny policy."""

import json
from dataclasses import dataclass

import imageio.v3 as imageio
import numpy as np
import pytest

from tensegym.cli.evaluate import Evaluate
from tensegym.cli.roll import Roll
from tensegym.control.policy import PolicyController, load_policy
from tensegym.control.table import make_controller
from tensegym.errors import DesignError, SimulationError
from tensegym.report import Report
from tensegym.robot.gait import GaitMetrics
from tensegym.robot.robot import TensegrityRobot
from tensegym.tasks.motions import as_task
from tensegym.tasks.policy_trials import policy_setup
from tensegym.tasks.roll import Roll as RollTask
from tensegym.tasks.rollout import Result
from tensegym.tasks.start import Start
from tensegym.tasks.trials import Setup, iterate, run_trials, summarise
from tests.conftest import assert_refused


def result(speed, *, passed=True, diverged=False, cost=10.0):
    gait = GaitMetrics(20.0, 0.7 * speed, speed, 1.0, 4, speed / 2, speed, 1.0, 1.0, cost, 0.0 if passed else 0.02,
                       100 * speed)  # fmt: skip
    return Result(0, Start(0, 0.0, 0.0), gait, {"drive_load": speed / 4, "stride": 30 * speed}, "time limit", diverged)


def test_summary_of_rows_made_by_hand():
    summary = summarise([result(s) for s in (0.1, 0.2, 0.3, 0.4, 1.0)])
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
    assert summary["stride_median"] == pytest.approx(9.0)
    assert summary["drive_load_max"] == pytest.approx(0.25)
    assert summary["peak_tension_max"] == pytest.approx(100.0)
    assert (summary["audit_failures"], summary["terminated"]) == (0, 0)


def test_the_way_of_a_trial_that_fails_the_audit_or_diverges_does_not_count():
    summary = summarise([result(0.2), result(0.3), result(9.0, passed=False), result(8.0, diverged=True)])
    assert summary["speed_lps_median"] == pytest.approx(0.1)  # of 0, 0, 0.2, 0.3
    assert summary["speed_lps_mean"] == pytest.approx(0.125)
    assert summary["speed_mps_median"] == pytest.approx(0.07)
    assert summary["audit_failures"] == 1
    assert summary["terminated"] == 1
    assert summary["audit_excess_max"] == 0.02


def test_one_trial_has_no_interval_and_standing_still_has_no_cost():
    summary = summarise([result(0.0, cost=np.inf)])
    assert summary["speed_lps_mean_ci95"] is None
    assert summary["cost_of_transport_median"] is None
    json.dumps(summary, allow_nan=False)


def test_trials_are_the_same_over_one_process_and_two(tiny_run):
    setup = policy_setup(str(tiny_run), seconds=2.0)
    seeds = [3, 1, 2, 9, 8]
    one, two = (run_trials(setup, seeds, jobs=jobs, quiet=True) for jobs in (1, 2))
    assert one == two
    assert [r.seed for r in one] == seeds
    assert len({r.gait.path for r in one}) == 5


def test_random_commands_repeat_by_seed_whatever_ran_before():
    setup = Setup("random", as_task({"motion": "roll", "seconds": 2.0}), {"kind": "random"})
    alone, after = (run_trials(setup, seeds, jobs=1, quiet=True) for seeds in ([5], [4, 5]))
    assert after[1] == alone[0]
    assert after[0].gait.path != after[1].gait.path


def test_what_fails_in_a_worker_is_raised_here(tmp_path):
    setup = Setup("walker", as_task("roll"), {"kind": "walker", "tips": str(tmp_path / "none.json")})
    with pytest.raises(FileNotFoundError, match="no table of tips"):
        run_trials(setup, range(8), jobs=2, quiet=True)


@dataclass(frozen=True, kw_only=True)
class Breaks(RollTask):
    """Every robot on an even face diverges while it settles."""

    def begin(self, robot, start, rng):
        if start.face % 2 == 0:
            raise SimulationError("diverged, as some robots do")
        return super().begin(robot, start, rng)


def test_an_episode_that_diverges_is_a_result_and_the_next_one_is_as_if_alone():
    wild, calm = (Setup("x", task(seconds=1.0, dt=0.004), {"kind": "random"}) for task in (Breaks, RollTask))
    results, alone = (run_trials(setup, range(6), jobs=1, quiet=True) for setup in (wild, calm))
    broken = [result.start.face % 2 == 0 for result in alone]
    assert 0 < sum(broken) < 6
    for result, other, bad in zip(results, alone, broken, strict=True):
        assert result.diverged == bad and result.start == other.start
        assert not result.sound and "while it settled: diverged" in result.ended if bad else result == other
    assert summarise(results)["terminated"] == sum(broken)


def test_an_episode_of_flexible_rods_does_not_depend_on_those_before_it():
    # once it did: the engine's restored state was not all of it, which two episodes of a hundred showed
    setup = policy_setup("flexible")
    alone, after = (list(iterate(setup, make_controller(setup.controller), seeds))[-1]
                    for seeds in ([10_005], [10_001, 10_003, 10_005]))  # fmt: skip
    assert after == alone


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
    assert frames.shape[0] == pytest.approx(50, abs=2)  # 2 s at 25 a second
    assert np.abs(frames[0].astype(float) - frames[-1]).max() > 50


def test_one_episode_with_baselines_as_json(tiny_run, tmp_path, cli, monkeypatch):
    from tensegym.control.tipping import Pull, Tip

    table = [Tip(Pull((0, 5), 0.3), face, (face + 1) % 20, (0.1, 0.0), 10.0) for face in range(20)]
    monkeypatch.setattr("tensegym.control.table.tips_of", lambda name: (table, None))
    status, text, _ = cli("evaluate", "--policy", tiny_run, "--out", tmp_path / "e", "--episodes", 1, "--seconds", 1,
                          "--jobs", 1, "--no-half-step", "--no-video", "--json")  # fmt: skip
    assert status == 0
    data = json.loads(text)
    assert list(data["summaries"]) == [str(tiny_run), "open-loop walker", "random commands"]
    assert data["summaries"]["random commands"]["speed_lps_mean_ci95"] is None
    assert sorted(p.name for p in (tmp_path / "e").iterdir()) == ["gait.png", "metrics.json"]


def test_the_policy_acts_on_normalised_observations_and_repeats(tiny_run):
    act = load_policy(tiny_run)
    observation = np.random.default_rng(0).uniform(-1, 1, act.observed).astype(np.float32)
    np.testing.assert_array_equal(act(observation), act(observation))
    assert np.abs(act(observation) - act(observation + 0.5)).max() > 0
    assert (np.abs(act(observation)) <= 1).all() and act(observation).shape == (6,)


def test_a_policy_for_another_observation_is_refused(tiny_run, tmp_path, cli):
    with (
        TensegrityRobot(dt=4e-3) as robot,
        pytest.raises(DesignError, match=r"observations of shape \(54,\), here they are \(132,\)"),
    ):
        PolicyController(str(tiny_run), observation="full").begin(robot)
    out = tmp_path / "e"
    assert_refused(cli("evaluate", "--policy", tiny_run, "--observation", "full", "--out", out), "(54,)", "(132,)")
    assert not out.exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--policy", "walking"], ["no policy 'walking'", "shipped are", "./walking"]),
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
