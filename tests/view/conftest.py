import numpy as np
import pytest

from tensegym import TensegrityRobot
from tensegym.replay import Recorder, Recording


@pytest.fixture(scope="session")
def recording() -> Recording:
    """A second of the default robot, its first drive winding."""
    recorder = Recorder("one drive winds", 0.05)
    with TensegrityRobot(dt=2e-3) as robot:
        robot.command(np.array([40.0, 0, 0, 0, 0, 0]))
        for _ in range(20):
            recorder.look(robot, face=0)
            robot.step(25)
        return recorder.recording()
