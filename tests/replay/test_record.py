"""An environment that is recorded does what it did, and leaves a replay of each episode."""

import gymnasium
import numpy as np
import pytest
from gymnasium.wrappers import RecordVideo

import tensegym
from tensegym.errors import InputError
from tensegym.replay import read_replay


def played(env, episodes=1, steps=2):
    seen = []
    for episode in range(episodes):
        env.reset(seed=episode)
        for _ in range(steps):
            seen.append(env.step(0.5 * np.ones(6))[0])
    env.close()
    return np.array(seen)


def make(**options):
    return gymnasium.make("tensegym/SixRodRolling-v0", **options)


def test_every_episode_leaves_its_replay_and_moves_as_it_did(tmp_path):
    plain = played(make(), episodes=2)
    recorded = played(tensegym.record(make(), tmp_path / "run-{}.html"), episodes=2)
    assert np.array_equal(plain, recorded)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run-1.html", "run-2.html"]
    replay = read_replay(tmp_path / "run-2.html")
    assert replay.seconds == pytest.approx(0.8)
    assert np.allclose(np.diff(replay.times), 0.02)
    assert np.allclose(np.linalg.norm(replay.directions, axis=1), 1)
    assert (replay.faces >= 0).all()


def test_an_episode_that_ends_is_written_then(tmp_path):
    env = tensegym.record(make(max_episode_steps=1), tmp_path / "run.html")
    env.reset(seed=0)
    assert not list(tmp_path.iterdir())
    assert env.step(np.zeros(6))[3]
    assert read_replay(tmp_path / "run.html").seconds == pytest.approx(0.4)
    env.close()


def test_a_place_to_go_to_stays_where_it_is(tmp_path):
    played(tensegym.record(gymnasium.make("tensegym/SixRodPlaces-v0"), tmp_path / "run.html"))
    places = read_replay(tmp_path / "run.html").places
    assert np.isfinite(places).all() and np.ptp(places, axis=0).max() < 1e-5


def test_what_cannot_be_recorded_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"takes an environment of tensegym, not CartPoleEnv"):
        tensegym.record(gymnasium.make("CartPole-v1"))
    with make() as env:
        for name, error in (("run.gif", InputError), ("none/run.html", FileNotFoundError)):
            with pytest.raises(error):
                tensegym.record(env, tmp_path / name)


def test_a_video_by_gymnasium_plays_at_true_speed(tmp_path):
    moviepy = pytest.importorskip("moviepy")
    env = RecordVideo(make(render_mode="rgb_array", control_period=0.2), str(tmp_path), disable_logger=True)
    played(env, steps=3)
    with moviepy.VideoFileClip(str(next(tmp_path.iterdir()))) as clip:
        assert clip.duration == pytest.approx((1 + 3) * 0.2)  # a picture of the start, and one a step
