"""Tables of tips and holds by name: the ones that ship, and what is said where there is none."""

from __future__ import annotations

from pathlib import Path

import pytest

import tensegym
from tensegym.control.table import make_controller
from tensegym.control.tabled import TIPS, holds_of, tips_of


@pytest.mark.parametrize("name", ["nobody", "holds", "tips", "../tips", "nobody.json", "a\nb", "x" * 400])
@pytest.mark.parametrize("kind", ["walker", "planner"])
def test_a_table_of_tips_that_is_not_there_says_what_to_do_instead(kind, name):
    with pytest.raises(FileNotFoundError) as refusal:
        make_controller({"kind": kind, "tips": name})
    text = str(refusal.value)
    assert "tensegym step --all-faces" in text
    assert name.endswith(".json") or all(known in text for known in ("six_rod", "three_rod_robot", "'own'"))
    assert len(text) <= 300 and "\n" not in text
    for folder in (Path(tensegym.__file__).parent, Path(tensegym.__file__).resolve().parents[1]):
        assert str(folder) not in text


def test_a_table_of_holds_that_is_not_there_says_how_to_make_one():
    with pytest.raises(FileNotFoundError, match=r"^no table of holds nobody; make one with `python bench"):
        make_controller({"kind": "stepper", "holds": "nobody"})


@pytest.mark.parametrize("name", TIPS)
def test_tables_that_ship_are_of_every_face_and_say_of_which_robot(name):
    rows, made_for = tips_of(name)
    assert made_for is not None
    assert {tip.from_face for tip in rows} == set(range(len(made_for.faces)))
    assert max(max(tip.pull.drives) for tip in rows) == len(made_for.drives) - 1
    assert holds_of("")[1] == tips_of("six_rod")[1]
