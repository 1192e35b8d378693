"""record: an environment that leaves a replay, or a video, of every episode."""

from __future__ import annotations

from pathlib import Path
from typing import Any, SupportsFloat

import gymnasium as gym
import numpy as np

from tensegym.envs.rolling import RollingEnv
from tensegym.errors import InputError
from tensegym.files import check_file

from .recorder import Recorder
from .replay_file import check_replay, write_replay
from .video import write_video

Env = gym.Env[np.ndarray, np.ndarray]


class Record(gym.Wrapper[np.ndarray, np.ndarray, np.ndarray, np.ndarray]):
    """Writes each episode when it ends; one that is not over, when the next one begins or the environment is closed.

    See `record`.
    """

    def __init__(self, env: Env, path: str | Path) -> None:
        super().__init__(env)
        rolling = env.unwrapped
        if not isinstance(rolling, RollingEnv):
            raise InputError(f"record() takes an environment of tensegym, not {type(rolling).__name__}")
        self._rolling, self._path, self._episodes = rolling, str(path), 0
        first = self._file(1)
        if first.suffix.lower() == ".mp4":
            check_file(first)
        else:
            check_replay(first)
        self._recorder: Recorder | None = None

    def _file(self, episode: int) -> Path:
        return Path(self._path.replace("{}", str(episode)))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """As the environment's."""
        self._write()
        found = self.env.reset(seed=seed, options=options)
        self._episodes += 1
        name = self.env.spec.id if self.env.spec else type(self._rolling).__name__
        self._rolling.watcher = self._recorder = Recorder(f"{name}, episode {self._episodes}")
        if self._rolling.episode:
            self._recorder(self._rolling.episode)
        return found

    def step(self, action: np.ndarray) -> tuple[np.ndarray, SupportsFloat, bool, bool, dict[str, Any]]:
        """As the environment's."""
        found = self.env.step(action)
        if found[2] or found[3]:
            self._write()
        return found

    def close(self) -> None:
        """Write an episode that is not over, and free the environment."""
        self._write()
        self.env.close()

    def _write(self) -> None:
        recorder, self._recorder, self._rolling.watcher = self._recorder, None, None
        if recorder is None:
            return
        file = self._file(self._episodes)
        write = write_video if file.suffix.lower() == ".mp4" else write_replay
        write(recorder.recording(), file)


def record(env: Env, path: str | Path = "run.html") -> Record:
    """Record every episode of an environment, 50 times a second, whatever its control period.

        env = tensegym.record(gymnasium.make("tensegym/SixRodRolling-v0"), "run-{}.html")

    Args:
        env: one of tensegym's, as `gymnasium.make` gives it. Its motion and its time limit stay as they are.
        path: the replay's file, of the episode's number where it has {} in it, else of the latest one; a name that
            ends in .mp4 writes videos, at true speed and 25 frames a second (extra train).

    Raises:
        InputError: another environment, or a path that cannot be written.
        FileNotFoundError: no such folder.
    """
    return Record(env, path)
