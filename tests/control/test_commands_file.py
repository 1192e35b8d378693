"""Command files as loggers and spreadsheets write them."""

from pathlib import Path

import numpy as np
import pytest

from tensegym.control.commands_file import read_commands

CASES = Path(__file__).parent / "cases"


@pytest.mark.parametrize("name", ["plain", "bom", "240hz_ms", "jitter"])
def test_what_people_write_is_read(name):
    times, angles = read_commands(CASES / f"commands_{name}.csv", 6)
    assert len(times) == len(angles) > 5 and angles.shape[1] == 6
    assert (np.diff(times) > 0).all() and np.isfinite(angles).all()


def test_semicolons_with_decimal_commas_are_the_same_numbers(tmp_path):
    plain = CASES / "commands_plain.csv"
    german = tmp_path / "german.csv"
    german.write_text(plain.read_text().replace(",", ";").replace(".", ","))
    for one, other in zip(read_commands(plain, 6), read_commands(german, 6), strict=True):
        np.testing.assert_array_equal(one, other)
