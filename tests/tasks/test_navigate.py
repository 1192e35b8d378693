"""Tasks whose direction changes, through the public interface."""

from __future__ import annotations

from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

from tensegym import as_task
from tensegym.cli.train import Train
from tensegym.errors import DesignError, TensegymError
from tensegym.robot.robot import TensegrityRobot
from tensegym.tasks.episode import Episode
from tensegym.tasks.trials import Setup, run_trials

ID = "tensegym/SixRodRolling-v0"


def test_what_is_seen_of_a_place_is_its_distance_and_that_the_heading_points_there():
    env = gym.make(ID, task={"motion": "places", "near": 3.0, "far": 3.0}, observation="full-goal").unwrapped
    seen, _ = env.reset(seed=3, options={"direction": 0.5})
    np.testing.assert_allclose(seen[-3:], [3 / 4, 1, 0], atol=0.01)
    bearing = env.episode.bearing
    np.testing.assert_allclose(bearing.direction, [np.cos(0.5), np.sin(0.5)], atol=0.02)  # it has settled a little
    heading, _ = gym.make(ID, observation="full").reset(seed=3, options={"direction": 0.5})
    assert len(seen) == len(heading) + 3
    env.close()


def test_the_reward_of_a_place_is_how_much_nearer_it_is():
    env = gym.make(ID, task={"motion": "places", "near": 9.0, "far": 9.0}).unwrapped
    env.reset(seed=1)
    first = env.episode.bearing.distance
    rng, made = np.random.default_rng(0), 0.0
    for _ in range(10):
        made += env.step(rng.uniform(-1, 1, 6))[4]["reward_terms"]["progress"]
    assert made * env.robot.design.length == pytest.approx(first - env.episode.bearing.distance, abs=1e-9)
    env.close()


def test_speed_counts_along_the_direction_wanted_at_the_time():
    task = as_task({"motion": "steer", "leg_least": 0.8, "leg_most": 0.8, "turn_least": 90.0, "turn_most": 90.0})
    with TensegrityRobot(dt=task.dt) as robot:
        episode, way, commands = Episode(robot, task, np.random.default_rng(5)), 0.0, np.random.default_rng(6)
        directions = []
        for _ in range(8):
            before, direction = robot.centre_of_mass_in_world(), episode.bearing.direction
            episode.advance(robot.angles_of(commands.uniform(-1, 1, 6)), 200)
            way += float(direction @ (robot.centre_of_mass_in_world() - before)[:2])
            directions.append(direction)
        assert episode.gait.speed * episode.gait.duration == pytest.approx(way, abs=1e-12)
        turns = [abs(float(a @ b)) for a, b in zip(directions[::2], directions[2::2], strict=False)]
        np.testing.assert_allclose(turns, 0, atol=1e-12)
        assert len(episode.goal.legs) == 4


def test_targets_come_from_the_episodes_seed_alone():
    setup = Setup("random", as_task({"motion": "places", "near": 0.6, "seconds": 8.0, "patience": 8.0}),
                  {"kind": "random"})  # fmt: skip
    one, two = run_trials(setup, [7, 8], jobs=1, quiet=True), run_trials(setup, [8], jobs=1, quiet=True)
    assert one[1] == two[0]
    assert set(one[0].measures) >= {"places", "places_a_minute", "leg_speed", "stalled", "stayed"}


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"near": 3.0, "far": 2.0}, "Navigate.near = 3 is above far = 2"),
        ({"leg_least": 20.0}, "Navigate.leg_least = 20 is above leg_most = 16"),
        ({"turn_least": 90.0, "turn_most": 45.0}, "Navigate.turn_least = 90 is above turn_most = 45"),
        ({"near": "two"}, "near"),
        ({"near": float("nan")}, "near"),
        ({"reach": -0.5}, "reach"),
        ({"headings": 2}, "headings"),
        ({"goal": "arrivals >= 2"}, "no metric measures 'arrivals'"),
    ],
)
def test_bad_fields_are_named(table, words):
    with pytest.raises(TensegymError, match=words):
        as_task({"motion": "places", **table})


def test_an_observation_that_there_is_not_is_named():
    for observation in ("goal", ["full-goal"]):
        with pytest.raises(DesignError, match=r"observation = .* is not one of full, onboard, full-goal, onboard-goal"):
            gym.make(ID, task="places", observation=observation)


@pytest.mark.parametrize("name", ["Steer", "Places", "Path"])
def test_each_task_has_an_environment_of_its_own(name):
    env = gym.make(f"tensegym/SixRod{name}-v0")
    env.reset(seed=0)
    info = env.step(np.zeros(6))[4]
    assert set(info["measures"]) == set(env.unwrapped.task.MEASURES)
    assert env.spec.max_episode_steps == round(env.unwrapped.task.seconds / 0.4)
    env.close()


def test_episodes_begin_on_the_faces_that_are_named_the_more_often_the_oftener():
    env = gym.make("tensegym/SixRodPlaces-v0", task={"motion": "places", "faces": [10, 3, 10, 10]})
    begun = [env.reset(seed=seed)[1]["face"] for seed in range(24)]
    env.close()
    assert {*begun} == {3, 10}
    assert begun.count(10) > begun.count(3)


def test_a_face_to_begin_on_that_a_robot_lacks_is_refused_before_anything_is_made(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(DesignError, match=r"Navigate.faces: 20 is outside 0\.\.19, the faces of 'six_rod'"):
        gym.make("tensegym/SixRodPlaces-v0", task={"motion": "places", "faces": [3, 20]})
    with pytest.raises(TensegymError, match=r"faces\[1\] = -1 is outside"):
        as_task({"motion": "places", "faces": [-1]})
    Path("begin.yaml").write_text("env: {task: {motion: roll, faces: [99]}}\n", encoding="utf-8")
    with pytest.raises(DesignError, match="99 is outside"):
        Train(config="begin.yaml").run()
    assert [path.name for path in tmp_path.iterdir()] == ["begin.yaml"]


def test_a_direction_that_has_drifted_turns_from_where_it_has_come_to():
    task = {"motion": "steer", "leg_least": 2.0, "leg_most": 2.0, "turn_most": 0.0, "drift": 30.0}
    env = gym.make("tensegym/SixRodSteer-v0", task=task, control_period=0.4).unwrapped
    env.reset(seed=1)
    angles = [np.arctan2(*env.episode.bearing.direction[::-1])]
    for _ in range(30):  # six legs
        env.step(-np.ones(6))
        angles.append(np.arctan2(*env.episode.bearing.direction[::-1]))
    turned = np.degrees(np.abs(np.diff(np.unwrap(angles))))
    assert turned.max() <= 12 + 1e-9  # 30 deg/s for 0.4 s
    assert np.ptp(np.unwrap(angles)) > np.radians(30)
    env.close()
