"""`tensegym build`: what it prints, what it writes, what it refuses."""

import json

import pytest

from tensegym.design.design_file import load_design
from tensegym.structures import BUILDERS
from tests.conftest import assert_refused


def test_a_prism_becomes_a_design_file_that_stands_as_built(cli, tmp_path):
    out = tmp_path / "d.toml"
    status, text, _ = cli("build", "prism", "--rods", 4, "--out", out, "--json")
    found = json.loads(text)
    assert status == 0
    assert found["standing"]["verdict"] == "stands"
    assert {name: group["cables"] for name, group in found["cables"].items()} == {"around": 8, "upright": 4}
    design = load_design(out)
    assert len(design.structure.rods) == 4
    assert design.shape.moved < 1e-9


def test_the_list_has_every_builder_with_its_parameters(cli):
    for command in (("build", "--list"), ("build",)):
        status, text, _ = cli(*command)
        assert status == 0
        assert all(f"\n{name}: " in f"\n{text}" for name in BUILDERS)
    assert "[3, 60]" in text


@pytest.mark.parametrize(("words", "reason"), [
    (["pyramid"], "'pyramid' is not one of prism, octahedron"),
    (["prism", "--solid", "cube"], "unknown"),
    (["prism", "--rods", "2"], "rods = 2 is outside [3, 60]"),
    (["prism", "--out", "d.json"], "must end in .toml"),
    (["prism", "--out", "none/d.toml"], "no folder none"),
    (["truncated", "--solid", "ball"], "is not one of tetrahedron"),
    (["prism", "--pretension", "-1"], "pretension = -1.0 is outside"),
    (["prism", "--pretension", "5e3"], "stretches a cable"),
])  # fmt: skip
def test_what_cannot_be_built_is_refused_in_a_line(cli, words, reason):
    assert_refused(cli("build", *words), reason)
