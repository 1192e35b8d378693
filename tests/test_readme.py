"""What the README says can be typed can be typed."""

import re
from pathlib import Path

import pytest

from tensegym.cli.main import COMMANDS
from tensegym.design.design_file import load_design

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()


def blocks():
    """Indented blocks of the README, dedented."""
    found = re.findall(r"(?:^    .*\n|^\n(?=    ))+", README, re.MULTILINE)
    return [re.sub(r"^    ", "", block, flags=re.MULTILINE).strip("\n") for block in found]


PYTHON = [block for block in blocks() if re.match(r"(import|from) ", block)]


@pytest.mark.parametrize("code", PYTHON, ids=range(len(PYTHON)))
def test_python_blocks_run(code, capsys):
    exec(compile(code, "README.md", "exec"), {})
    assert capsys.readouterr().out


def test_both_python_blocks_were_found():
    assert len(PYTHON) == 2


def test_the_design_block_is_a_design(tmp_path):
    (text,) = [block for block in blocks() if block.startswith("preset = ")]
    (tmp_path / "d.toml").write_text(text)
    design = load_design(tmp_path / "d.toml")
    assert design.elastic_cable.stiffness == 400
    assert design.payload is not None


def test_every_command_is_named_and_every_named_command_exists():
    assert set(re.findall(r"`tensegym (\w+)", README)) == set(COMMANDS)


def test_every_make_target_named_exists():
    targets = set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    assert set(re.findall(r"^    make ([a-z]+)", README, re.MULTILINE)) <= targets


def test_every_linked_file_exists():
    for path in re.findall(r"\]\(([\w/.]+)\)", README):
        assert (ROOT / path).is_file(), path
