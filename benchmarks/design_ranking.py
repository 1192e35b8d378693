"""Does a policy conditioned on the design rank designs as a search of a generator's parameters for each of them does?

    python benchmarks/design_ranking.py --out runs/ranking

Draws robots from the ranges the policy was trained over. Each is scored by the mean speed over new starts, once under
the policy as it is, once under the best pattern generator that a search of the task's controller parameters finds for
it. A killed run goes on where it was. Prints both scores, Spearman's rank correlation with a bootstrap's 95 % interval,
and draws them.
"""

from __future__ import annotations

import json
import sys
import time
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
import tyro
from scipy.stats import spearmanr
from tqdm import tqdm

from tensegym.design.design import RobotDesign
from tensegym.design.design_file import as_design, design_to_dict
from tensegym.design.variation import parse_variation
from tensegym.plotting import COLOURS, new_figure, save, thin_legend
from tensegym.processes import Pool
from tensegym.report import table
from tensegym.search.confirm import FIRST_SEED, TIME_STEP
from tensegym.search.evaluate import TrialSpec, try_all
from tensegym.search.loop import run_search
from tensegym.search.problem import Problem, load_problem, problem_from
from tensegym.search.store import Store
from tensegym.search.winner import ranked


@dataclass(frozen=True)
class Ranking:
    """Rank random designs by a conditioned policy and by a search for each."""

    out: Path = Path("runs/ranking")
    """Folder for the searches, scores.json and ranking.png."""
    policy: str = "conditioned"
    """A policy trained with `vary`, shipped or a run's folder; or `none`: only search."""
    task: str = "carry"
    """Task file, for its motion and its controller's space."""
    designs: int = 30
    """Random designs."""
    budget: int = 25
    """Trials of each design's search."""
    episodes: int = 20
    """New starts of a score."""
    jobs: int = 1
    """Processes."""
    config: str = "conditioned"
    """Training config whose ranges the designs are drawn from."""

    def run(self) -> str:
        designs = drawn(self.config, self.designs)
        scores = _Scores(self.out / "scores.json")
        with Pool(self.jobs) as engine:
            for i in tqdm(range(len(designs)), desc="searches", unit="design", file=sys.stderr):
                if f"search {i}" not in scores.kept:
                    scores.add(f"search {i}", self._searched(designs[i], self.out / f"design-{i:02d}", engine))
            if self.policy == "none":
                return ""
            asked = {"policy": self.policy, "gain": 1.0, "amplitudes": [0.0, 0.0]}
            for i in tqdm(range(len(designs)), desc=self.policy, unit="design", file=sys.stderr):
                if f"{self.policy} {i}" not in scores.kept:
                    scores.add(f"{self.policy} {i}", self._score(designs[i], asked, engine))
        ours = np.array([scores.kept[f"{self.policy} {i}"]["mean"] for i in range(len(designs))])
        theirs = np.array([scores.kept[f"search {i}"]["mean"] for i in range(len(designs))])
        errors = [np.array([scores.kept[f"{who} {i}"]["error"] for i in range(len(designs))])
                  for who in (self.policy, "search")]  # fmt: skip
        _draw(ours, theirs, (errors[0], errors[1]), self.out / "ranking.png")
        return _told(designs, ours, theirs, scores.kept, self.policy)

    def _searched(self, design: RobotDesign, folder: Path, engine: Pool) -> dict[str, float]:
        """Score of the best controller that a search finds."""
        begun = time.perf_counter()
        folder.mkdir(parents=True, exist_ok=True)
        problem = for_design(self.task, design)
        store = Store(folder, problem)
        run_search(problem, store, engine, self.budget)
        finished = store.finished()
        best = finished[ranked(problem, finished)[0]]
        seconds = time.perf_counter() - begun
        found = self._score(design, problem.space.apply(best[0])["controller"], engine)
        return found | {"searched": best[1].metrics["speed_lps"], "seconds": seconds}

    def _score(self, design: RobotDesign, controller: dict[str, Any], engine: Pool) -> dict[str, float]:
        """Mean speed [L/s] over new starts, its standard error, and the seconds it took."""
        begun = time.perf_counter()
        task = load_problem(self.task).task
        task = replace(task, dt=TIME_STEP, patience=task.seconds)
        seeds = [tuple(FIRST_SEED + s for s in part) for part in np.array_split(range(self.episodes), self.jobs)]
        trials = [TrialSpec(i, design_to_dict(design), controller, task, part) for i, part in enumerate(seeds)]
        speeds = [e["speed_lps"] for tried in engine.map(try_all, trials) for e in tried.episodes]
        error = np.std(speeds, ddof=1) / np.sqrt(len(speeds))
        return {"mean": float(np.mean(speeds)), "error": float(error), "seconds": time.perf_counter() - begun}


def drawn(config: str, count: int, seed: int = 0) -> list[RobotDesign]:
    """Random designs from the ranges of a training."""
    from tensegym.train.config import load_config

    env = load_config(config).env
    base = as_design(env["design"])
    rng = np.random.default_rng(seed)
    return [parse_variation(env["vary"], base).draw(base, rng) for _ in range(count)]


def for_design(task: str, design: RobotDesign) -> Problem:
    """The search of a task's controller parameters alone, for one design, at the environments' time step."""
    data = tomllib.loads(load_problem(task).text)
    data["task"]["dt"] = TIME_STEP
    data["search"]["episodes"] = 4
    data["design"] = design_to_dict(design)
    data["space"] = {name: spec for name, spec in data["space"].items() if name.startswith("controller.")}
    return problem_from(tomli_w.dumps(data), f"{task} of one design")


class _Scores:
    """What has been measured, written after each."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.kept: dict[str, dict[str, float]] = json.loads(path.read_text()) if path.is_file() else {}

    def add(self, name: str, score: dict[str, float]) -> None:
        self.kept[name] = score
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_text(json.dumps(self.kept, indent=1))


def correlation(ours: np.ndarray, theirs: np.ndarray, draws: int = 2000) -> tuple[float, float, float]:
    """Spearman's, with the 2.5 % and 97.5 % quantiles over designs drawn with replacement."""
    rng = np.random.default_rng(0)
    picks = rng.integers(len(ours), size=(draws, len(ours)))
    low, high = np.nanquantile([spearmanr(ours[p], theirs[p]).statistic for p in picks], [0.025, 0.975])
    return float(spearmanr(ours, theirs).statistic), float(low), float(high)


def _told(
    designs: list[RobotDesign], ours: np.ndarray, theirs: np.ndarray, scores: dict[str, dict[str, float]], policy: str
) -> str:
    rows = [[i, ours[i], scores[f"{policy} {i}"]["error"], theirs[i], scores[f"search {i}"]["error"]]
            for i in np.argsort(-theirs)]  # fmt: skip
    text = table(["design", f"{policy} L/s", "error", "search L/s", "error"], rows)
    rank, low, high = correlation(ours, theirs)
    spent = {who: sum(scores[f"{who} {i}"]["seconds"] for i in range(len(designs))) for who in (policy, "search")}
    best = int(np.argmax(ours))
    return (
        f"{text}\nSpearman's rank correlation {rank:.2f}, 95 % from {low:.2f} to {high:.2f}, over {len(ours)} designs\n"
        f"the policy's best design, {best}, is number {int((theirs > theirs[best]).sum()) + 1} of the searches; "
        f"median L/s {np.median(ours):.3f} with the policy, {np.median(theirs):.3f} with a search each\n"
        f"seconds: {spent[policy]:.0f} with the policy, {spent['search']:.0f} with the searches"
    )


def _draw(ours: np.ndarray, theirs: np.ndarray, errors: tuple[np.ndarray, np.ndarray], out: Path) -> None:
    """Both scores of each robot with their standard errors; named are the best one of either."""
    figure, axes = new_figure(size=(6, 5.5))
    axes.errorbar(theirs, ours, xerr=errors[1], yerr=errors[0], fmt="o", ms=4, color=COLOURS[0], ecolor="0.7", lw=1,
                  label="a robot, and standard errors")  # fmt: skip
    ends = [0.0, float(max(ours.max(), theirs.max()))]
    axes.plot(ends, ends, color="0.4", lw=1, ls="--", label="equally fast")
    for best in {int(ours.argmax()), int(theirs.argmax())}:
        axes.annotate(f"robot {best}", (theirs[best], ours[best]), xytext=(-8, -14), textcoords="offset points",
                      ha="right")  # fmt: skip
    axes.set(xlabel="best generator of a search for the robot: mean speed [rod lengths/s]",
             ylabel="policy conditioned on the robot: mean speed [rod lengths/s]")  # fmt: skip
    thin_legend(axes, loc="lower right")
    save(figure, out)


if __name__ == "__main__":
    print(tyro.cli(Ranking).run())
