"""Facts as JSON: NumPy's numbers are plain ones, and what is not finite is null with a reason."""

import json
import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tensegym.report import table, to_json


def test_numbers_that_are_not_finite_are_null_and_named():
    data = {"gait": {"cost": math.inf, "speed": 0.3}, "rows": [[1.0, -math.inf], (np.float64("nan"),)]}
    assert json.loads(to_json(data)) == {
        "gait": {"cost": None, "speed": 0.3},
        "rows": [[1.0, None], [None]],
        "not_finite": {"gait.cost": "inf", "rows.0.1": "-inf", "rows.1.0": "nan"},
    }


def test_numpy_is_written_as_plain_numbers():
    data = {"n": np.int64(3), "yes": np.bool_(True), "x": np.array([[1.5, np.nan]])}
    assert json.loads(to_json(data)) == {"n": 3, "yes": True, "x": [[1.5, None]], "not_finite": {"x.0.1": "nan"}}


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=20,
)


@given(st.dictionaries(st.text(), JSON))
def test_finite_facts_come_back_as_they_went(data):
    assert json.loads(to_json(data)) == data


def test_tables_align_and_give_four_digits():
    lines = table(["name", "x"], [["a", 1 / 3], ["longer", "-"]]).splitlines()
    assert lines == ["name    x", "------  ------", "a       0.3333", "longer  -"]
