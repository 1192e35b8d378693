"""`tensegym bench`: what it refuses, and that a part runs and keeps the form of its rows."""

import json

import pytest

from tensegym.cli import bench
from tensegym.cli.bench import Bench
from tensegym.errors import InputError


def test_a_part_runs_and_writes_its_rows(tmp_path):
    report = Bench("startup", rounds=1, out=tmp_path / "rows.json").run()
    data = json.loads((tmp_path / "rows.json").read_text())
    assert data == json.loads(json.dumps(report.data))
    assert set(data["machine"]) == {"processor", "cores", "load", "python", "versions"}
    for row in data["rows"]:
        assert set(row) >= {"name", "ours", "peer", "unit", "ratio", "spread"}
        assert row["spread"][0] <= row["ratio"] <= row["spread"][1]
        assert row["name"] in report.text


def test_bad_input_is_refused_before_anything_is_timed(tmp_path, monkeypatch):
    with pytest.raises(InputError, match="rounds"):
        Bench(rounds=0).run()
    with pytest.raises(InputError, match="no folder"):
        Bench(out=tmp_path / "nowhere" / "rows.json").run()
    monkeypatch.setattr(bench, "FOLDER", tmp_path)
    with pytest.raises(InputError, match="checkout"):
        Bench().run()
