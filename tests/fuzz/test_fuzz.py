"""A small share of `make fuzz`: damaged input is refused by the project's own exceptions, in one short line."""

import pytest
from hypothesis import HealthCheck, given, settings

from tests.fuzz.judge import NAMES, trial


@pytest.mark.parametrize("name", NAMES)
def test_damaged_input_is_accepted_or_refused(name, tmp_path):
    inputs, judge = trial(name, tmp_path)

    @settings(max_examples=20, deadline=None, database=None, derandomize=True,
              suppress_health_check=list(HealthCheck))
    @given(inputs)
    def run(given_input):
        judge(given_input)

    run()
