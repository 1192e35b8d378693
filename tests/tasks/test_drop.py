"""The task drop: fallen before it begins."""

import numpy as np

from tensegym import as_task
from tensegym.robot.robot import TensegrityRobot
from tensegym.tasks.episode import Episode


def test_it_has_fallen_and_come_to_rest_when_the_episode_begins():
    task = as_task({"motion": "drop", "drop": 2.0})
    with TensegrityRobot(dt=task.dt) as robot:
        episode = Episode(robot, task, np.random.default_rng(3))
        assert episode.sound
        assert robot.energies().kinetic < 0.02
        assert 0.1 < robot.centre_of_mass_in_world()[2] / robot.design.length < 0.6
