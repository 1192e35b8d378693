"""A search of seconds: short episodes of the bare robot, two fields."""

import pytest

from tensegym.search.problem import problem_from

TINY = """
[task]
motion = "roll"
seconds = 0.8
settle = 0.1
dt = 0.004
[controller]
amplitudes = [0.5, 0.5]
[space]
"design.elastic_cable.pretension" = {low = 5.0, high = 20.0, log = true}
"controller.lags" = {low = -1.0, high = 1.0}
[search]
sampler = "random"
batch = 3
episodes = 2
"""


@pytest.fixture
def tiny():
    """Parsed; pass replacements of pieces of the text."""

    def make(*changes: tuple[str, str]):
        text = TINY
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        return problem_from(text, "tiny")

    return make


@pytest.fixture
def tiny_file(tmp_path):
    path = tmp_path / "tiny.toml"
    path.write_text(TINY)
    return path
