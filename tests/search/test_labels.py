"""Axes are named in words with units."""

import pytest

from tensegym.search.labels import metric_label, parameter_label


@pytest.mark.parametrize("name, label", [
    ("design.elastic_cable.stiffness", "elastic cable: stiffness [N/m]"),
    ("design.drive.gear_ratio", "drive: gear ratio"),
    ("controller.frequency", "controller: frequency [Hz]"),
    ("design.structure.rod_length", "structure: rod length [m]"),
    ("vary.anything", "vary: anything"),
])  # fmt: skip
def test_a_parameter_has_the_unit_of_its_field(name, label):
    assert parameter_label(name) == label


def test_a_metric_of_ones_own_is_its_words():
    assert metric_label("speed_lps") == "speed [rod lengths/s]"
    assert metric_label("left_circle") == "left circle"
