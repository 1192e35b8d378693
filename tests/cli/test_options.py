"""Numbers on the command line: each has a range, and one outside it is refused before anything is written."""

import dataclasses
import typing
from importlib import import_module

import pytest

from tensegym.cli.main import COMMANDS
from tensegym.cli.options import Within
from tests.conftest import assert_refused


def commands(table=COMMANDS, prefix=()):
    for name, (target, _) in table.items():
        module, attribute = target.split(":")
        found = getattr(import_module(module), attribute)
        if isinstance(found, dict):
            yield from commands(found, (*prefix, name))
        elif dataclasses.is_dataclass(found) and found.__module__.startswith("tensegym.cli"):
            yield (*prefix, name), found


def numbers(command):
    hints = typing.get_type_hints(command, include_extras=True)
    for field in dataclasses.fields(command):
        if dataclasses.is_dataclass(hints[field.name]):
            yield from numbers(hints[field.name])
        elif parts(hints[field.name]) & {int, float}:
            yield field.name, hints[field.name]


def parts(hint):
    found = {hint} if isinstance(hint, type) else set()
    return found.union(*(parts(part) for part in typing.get_args(hint)))


def ranges(hint):
    own = [extra for extra in getattr(hint, "__metadata__", ()) if isinstance(extra, Within)]
    return own + [within for part in typing.get_args(hint) for within in ranges(part)]


ALL = dict(commands())


@pytest.mark.parametrize("name", ALL, ids=" ".join)
def test_every_number_has_a_range_of_its_own_kind(name):
    for option, hint in numbers(ALL[name]):
        assert ranges(hint), option
        for within in ranges(hint):  # two where an option takes a pair
            assert within.low < within.high
            assert {type(within.low), type(within.high)} == parts(hint) & {int, float}, option


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (("design", "run", "--jobs", -1, "--out", "x"), ("jobs = -1 is outside [1, 512]",)),
        (("design", "run", "--budget", 0, "--out", "x"), ("budget = 0 is outside [1, 1e+09]",)),
        (("design", "run", "--seed", 2**31, "--out", "x"), ("seed = 2147483648",)),
        (("train", "--seed", -1, "--out", "x"), ("seed = -1",)),
        (("train", "--steps", 0, "--out", "x"), ("steps = 0",)),
        (("step", "--depth", "nan", "--out", "x"), ("depth = nan is outside [0, 1]",)),
        (("step", "--dt", "inf", "--out", "x"), ("dt = inf", " s")),
        (("flexure", "fit", "tfch", "--held-out", -1, "--out", "x"), ("held_out = -1",)),
        (("flexure", "fit", "tfch", "--thickness-mm", "nan", "--out", "x"), ("thickness_mm = nan", "mm")),
        (("flexure", "table", "--loops", 10**12), ("loops = 1000000000000",)),
    ],
)
def test_a_number_outside_its_range_is_refused_and_nothing_is_written(command, words, cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert_refused(cli(*command), *words)
    assert not list(tmp_path.iterdir())


def test_help_shows_the_ranges(cli):
    _, text, _ = cli("design", "run", "--help")
    assert "--jobs 1..512" in text
    _, text, _ = cli("simulate", "--help")
    assert "1e-06..0.004 s" in text
