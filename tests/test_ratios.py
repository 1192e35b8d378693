"""`benchmarks/ratios.py`: what it refuses, and that a part runs and keeps the form of its rows."""

import json
import sys
from pathlib import Path

import pytest

from tensegym.errors import InputError

FOLDER = Path(__file__).parents[1] / "benchmarks"


@pytest.fixture
def ratios(monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))
    import ratios

    yield ratios.Ratios
    for name in ("ratios", "timing", "startup"):
        sys.modules.pop(name, None)


def test_a_part_runs_and_writes_its_rows(ratios, tmp_path):
    report = ratios("startup", rounds=1, out=tmp_path / "rows.json").run()
    data = json.loads((tmp_path / "rows.json").read_text())
    assert data == json.loads(json.dumps(report.data))
    assert set(data["machine"]) == {"processor", "cores", "load", "python", "versions", "substeps"}
    for row in data["rows"]:
        assert set(row) >= {"name", "ours", "peer", "unit", "ratio", "spread"}
        assert row["spread"][0] <= row["ratio"] <= row["spread"][1]
        assert row["name"] in report.text


def test_bad_input_is_refused_before_anything_is_timed(ratios, tmp_path):
    with pytest.raises(InputError, match="rounds = 0"):
        ratios(rounds=0).run()
    with pytest.raises(InputError, match="no folder"):
        ratios(out=tmp_path / "nowhere" / "rows.json").run()
