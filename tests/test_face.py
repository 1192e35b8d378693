"""The public face: its names, their one-line descriptions, and that none of them costs anything before it is used."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

import tensegym

SOURCE = ast.parse(Path(tensegym.__file__).read_text())


@pytest.mark.parametrize("name", tensegym.__all__)
def test_every_name_is_there_and_has_a_docstring_of_its_own(name):
    assert getattr(tensegym, name).__name__ == name
    assert getattr(tensegym, name).__doc__


def test_every_name_has_one_line_in_the_docstring():
    described = re.findall(r"^    (\w+)  +\S", tensegym.__doc__, re.MULTILINE)
    assert sorted([*described, "TensegymError"]) == sorted(tensegym.__all__)


def test_type_checkers_see_the_same_names():
    (block,) = [node for node in SOURCE.body if isinstance(node, ast.If)]
    seen = [(node.module, alias.name) for node in block.body for alias in node.names]
    assert sorted(name for _, name in seen) == sorted(tensegym.__all__)
    assert sorted(seen) == sorted((f"tensegym.{home}", n) for home, names in tensegym._HOMES.items() for n in names)


def test_a_name_that_is_not_there_is_an_attribute_error():
    with pytest.raises(AttributeError, match="'tensegym' has no attribute 'RobotDesing'"):
        tensegym.RobotDesing  # noqa: B018


def test_help_is_a_page():
    done = subprocess.run([sys.executable, "-c", "import tensegym; help(tensegym)"], capture_output=True, text=True)
    assert all(name in done.stdout for name in tensegym.__all__)
    assert len(done.stdout.splitlines()) < 100


def test_the_module_is_the_command():
    done = subprocess.run([sys.executable, "-m", "tensegym", "--version"], capture_output=True, text=True)
    assert done.stdout.strip() == tensegym.__version__
