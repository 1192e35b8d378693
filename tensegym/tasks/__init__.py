"""What is to be done, and how well it was done.

    task.py       Task: start, goal, ground, end, reward terms, metrics; the base class of all
    roll.py       Roll; step_onto.py: StepOnto, to tip or to rest; motions.py: tasks by name, and from tables
    course.py     Course; obstacles.py, and where they lie: lane.py
    goal.py       what an episode wants; start.py: where it begins; reward.py; bound.py
    episode.py    Episode: one try, advanced a control step at a time; environments step one
    rollout.py    rollout: a controller drives a robot through an episode
    trials.py     run_trials: many of them over processes; summarise
    policy_trials.py  evaluate: those of a policy, as it was trained
"""

from .bound import Bound
from .episode import Episode, Watcher
from .goal import Goal, Heading
from .motions import MOTIONS, as_task
from .policy_trials import evaluate, policy_setup
from .reward import RewardWeights
from .roll import Roll
from .rollout import Result, rollout
from .start import Start
from .step_onto import StepOnto
from .task import Task
from .trials import Setup, run_trials, summarise

__all__ = [
    "MOTIONS", "Bound", "Episode", "Goal", "Heading", "Result", "RewardWeights", "Roll", "Setup", "Start", "StepOnto",
    "Task", "Watcher", "as_task", "evaluate", "policy_setup", "rollout", "run_trials", "summarise",
]  # fmt: skip
