import math

import numpy as np
import pytest

from tensegym.tasks.stride import WINDOW, time_to_stride


def test_a_robot_that_waits_and_then_goes_steadily():
    times = np.arange(0, 40.01, 0.4)
    way = 0.5 * np.maximum(times - 8.0, 0.0)
    seconds, steady = time_to_stride(way, 0.4)
    assert steady == pytest.approx(0.5)
    assert seconds == pytest.approx(8.0 - 0.1 * WINDOW, abs=0.41)  # 90 % of the window is enough


def test_one_that_goes_from_the_start_and_one_that_never_does():
    assert time_to_stride(np.arange(100) * 0.1, 0.4) == (0.0, pytest.approx(0.25))
    assert time_to_stride(np.zeros(100), 0.4) == (math.inf, 0.0)
