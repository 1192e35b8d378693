"""`tensegym import` and the exports that it reads: through the command line and back."""

import json
from pathlib import Path

import numpy as np
import pytest

from tensegym.design.design_file import load_design
from tests.conftest import assert_refused

CASES = Path(__file__).parents[1] / "exchange" / "cases"


@pytest.mark.parametrize(("to", "words"), [
    ("ntrt", ["model.yaml"]), ("matrices", ["nodes.csv", "--rods", "rods.csv", "--cables", "cables.csv"]),
])  # fmt: skip
def test_a_design_goes_out_and_comes_in(cli, tmp_path, monkeypatch, to, words):
    assert cli("export", "six_rod", "--to", to, "--units", "cm", "--out", tmp_path / "out")[0] == 0
    monkeypatch.chdir(tmp_path / "out")
    status, text, _ = cli("import", *words, "--units", "cm", "--out", "back.toml", "--json")
    assert status == 0
    assert json.loads(text)["standing"]["verdict"] == "stands"
    back, given = load_design(tmp_path / "out" / "back.toml"), load_design(tmp_path / "out" / "design.toml")
    np.testing.assert_allclose(back.standing.nodes, given.standing.nodes, atol=1e-9)
    if to == "ntrt":
        assert back.mass == pytest.approx(given.mass)


@pytest.mark.parametrize(("words", "reason"), [
    (["prism3.yaml"], "give units"),
    (["none.yaml", "--units", "m"], "none.yaml"),
    (["prism3.yaml", "--units", "mm"], "m long, outside [0.01, 30] m"),
    (["prism3.txt", "--units", "m"], "neither in .yaml"),
    (["nodes.csv", "--units", "m"], "--rods and --cables"),
    (["prism3.yaml", "--units", "dm", "--out", "x.yaml"], "must end in .toml"),
])  # fmt: skip
def test_what_cannot_be_read_is_refused_in_a_line(cli, monkeypatch, words, reason):
    monkeypatch.chdir(CASES)
    assert_refused(cli("import", *words), reason)
