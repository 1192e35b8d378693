import numpy as np
import pytest

from tensegym.errors import InputError
from tensegym.search.measure import Objective, aggregate
from tensegym.search.winner import pareto
from tensegym.tasks.bound import Bound
from tensegym.tasks.rollout import WORST_COST


def test_a_bound_is_broken_in_units_of_its_limit():
    goal, limit = Bound.parse("speed_lps >= 0.2"), Bound.parse(" slip_share<=0.3 ")
    assert goal.violation({"speed_lps": 0.1}) == pytest.approx(0.5)
    assert goal.violation({"speed_lps": 0.3}) == pytest.approx(-0.5)
    assert limit.violation({"slip_share": 0.6}) == pytest.approx(1.0)
    assert str(limit) == "slip_share <= 0.3"


@pytest.mark.parametrize("text", ["speed_lps", "speed_lps > 0.2", "speed_lps >= fast", "speed_lps >= nan", 3])
def test_what_is_no_bound(text):
    with pytest.raises(InputError, match="METRIC >= NUMBER"):
        Bound.parse(text)


def test_what_is_no_objective():
    with pytest.raises(InputError, match="write max METRIC or min METRIC"):
        Objective.parse("speed_lps")


def test_episodes_add_up_to_energy_over_weight_times_way():
    one = {"speed": 0.2, "duration": 10.0, "energy": 30.0, "weight": 15.0, "audit_excess": 0.0}
    other = {"speed": 0.0, "duration": 5.0, "energy": 10.0, "weight": 15.0, "audit_excess": 0.2}
    both = aggregate([one, other])
    assert both["cost_of_transport"] == pytest.approx(40 / (15 * 2))
    assert both["audit_excess"] == 0.2
    assert both["speed"] == pytest.approx(0.1)
    assert aggregate([other])["cost_of_transport"] == WORST_COST


def test_the_pareto_front_is_what_nothing_beats():
    losses = np.array([[0.0, 3.0], [1.0, 1.0], [2.0, 2.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0]])
    assert pareto(losses) == [0, 1, 3, 5]
