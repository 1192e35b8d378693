"""`tensegym fields`: whatever a file may hold is said, and nothing else."""

import json

import pytest
import yaml

from tensegym.cli.fields import FILES, Fields, example, rows, sections
from tensegym.search.problem import problem_from
from tensegym.tables import fill
from tensegym.train.config import TrainConfig
from tests.conftest import assert_refused


def test_every_kind_of_file_is_listed_and_in_the_help(cli):
    status, out, _ = cli("fields")
    assert status == 0
    assert all(line.split()[0] in FILES for line in out.splitlines()[2:])
    assert "Kind of file: " + ", ".join(FILES) + ";" in " ".join(Fields.__doc__.split() + _help(cli).split())


def _help(cli):
    return " ".join(cli("fields", "--help")[1].replace("│", " ").split())


@pytest.mark.parametrize("name", FILES)
def test_every_field_has_a_meaning(name, cli):
    status, out, _ = cli("fields", name, "--json")
    assert status == 0
    listed = json.loads(out)
    assert set(listed) == {section.title for section in sections(name) if rows(section)}
    assert [f"{title}.{row['field']}" for title, found in listed.items() for row in found if not row["meaning"]] == []
    assert example(name)


def test_a_range_and_a_unit_are_those_that_the_reader_holds_to(cli):
    out = cli("fields", "design")[1]
    (line,) = [line for line in out.splitlines() if line.startswith("pretension") and "every elastic cable" in line]
    assert line.split()[:5] == ["pretension", "10", "N", "[0,", "10000]"]


def test_the_examples_are_files():
    shown = example("training").partition("\n\n")[2]
    assert fill(TrainConfig, yaml.safe_load(shown), "", ValueError).n_envs == 8
    shown = example("task").partition("\n\n")[2].replace("[design]", "[design.payload]\n[design]", 1)
    assert problem_from(shown, "the example").settings.sampler == "cmaes"


def test_a_kind_that_there_is_not(cli):
    assert_refused(cli("fields", "robots"), "'robots'", "design, task, training")
