"""What is seen of a training while it runs: a progress bar, and a row of its curve an update."""

from __future__ import annotations

import csv
import math
import time
from pathlib import Path
from typing import Any

import numpy as np
from stable_baselines3.common.callbacks import BaseCallback

from tensegym.files import replace_file

from .curve import CURVE, FIELDS
from .state import TrainState


class Watch(BaseCallback):
    """Progress bar, and one row of curve.csv an update from the episodes that ended in it."""

    def __init__(self, bar: Any, out: Path, state: TrainState, metric: str) -> None:
        super().__init__()
        self.bar, self.state, self.path = bar, state, out / CURVE
        self.began = time.perf_counter()
        self.metric, self.gaits, self.goals = metric, list[dict[str, Any]](), list[float]()

    def _on_step(self) -> bool:
        self.bar.update(self.training_env.num_envs)
        for done, info in zip(self.locals["dones"], self.locals["infos"], strict=True):
            if done:
                self.gaits.append(info["gait"])
                self.goals.append((info["gait"] | info.get("measures", {})).get(self.metric, math.nan))
        return True

    def _on_training_end(self) -> None:
        if not self.gaits:
            return
        speeds = np.array([g["speed_lps"] for g in self.gaits])
        row = (
            self.num_timesteps, (self.state.seconds + time.perf_counter() - self.began) / 3600, len(self.gaits),
            np.median(speeds), np.quantile(speeds, 0.1), np.median([g["slip_share"] for g in self.gaits]),
            np.mean([g["tips"] for g in self.gaits]), np.max([g["audit_excess"] for g in self.gaits]),
            float(self.model.policy.log_std.detach().exp().mean()), float(np.mean(self.goals)),
        )  # fmt: skip
        before = self.path.read_text()
        with replace_file(self.path) as file:
            file.write(before)
            csv.writer(file, lineterminator="\n").writerow([f"{v:.6g}" if isinstance(v, float) else v for v in row])
        for name, value in zip(FIELDS[3:], row[3:], strict=True):
            self.logger.record(f"gait/{name}", float(value))
        self.bar.set_postfix_str(f"{np.median(speeds):.3f} L/s, slip {row[5]:.2f}, {self.metric} {row[-1]:.3g}")
