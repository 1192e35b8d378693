"""What a winner gains over the start, and how sure that is."""

import numpy as np
import pytest

from tensegym.search.confirm import gain, judge
from tensegym.tasks.bound import Bound


def episodes(speeds):
    return [{"speed_lps": speed} for speed in speeds]


def test_the_interval_is_that_of_the_differences_from_the_same_starts():
    start, apart = np.random.default_rng(0).uniform(0, 1, 64), np.tile([0.1, 0.3], 32)
    found = gain(episodes(start), episodes(start + apart), "speed_lps")
    reach = 1.96 * 0.1 * np.sqrt(64 / 63) / 8  # two values of equal share: deviation 0.1 about 0.2
    assert (found.mean, found.low, found.high) == pytest.approx((0.2, 0.2 - reach, 0.2 + reach))
    assert found.start == pytest.approx(start.mean())


@pytest.mark.parametrize(("apart", "word"), [(-0.1, "below"), (0.1, "above"), (0.0, "not to be told from")])
def test_the_winner_is_said_to_be_slower_where_it_is(apart, word):
    wobble = np.tile([-0.05, 0.05], 20)
    text = gain(episodes(np.full(40, 0.3)), episodes(0.3 + apart + wobble), "speed_lps").text
    assert text.startswith(f"speed_lps is {word} the start's: ") and text.endswith("from 0.3")


@pytest.mark.parametrize(("bound", "kept"), [
    ("speed_lps >= 0.25", True), ("speed_lps >= 0.3", False), ("speed_lps <= 0.25", True), ("speed_lps <= 0.2", False),
])  # fmt: skip
def test_a_goal_that_is_not_reached_is_said_so(bound, kept):
    """By the mean, whatever single episodes do."""
    verdict = judge(Bound.parse(bound), episodes([0.0, 0.25, 0.5]))
    assert (verdict.kept, verdict.mean) == (kept, 0.25)
    assert verdict.text == f"{bound} is {'kept' if kept else 'not kept'}: 0.25 in the mean"
