"""docs/validation.md: made of its results, complete, honest, and still what is measured; and how it is made."""

import json
from pathlib import Path

import pytest

from tensegym.robot.engines import ENGINES
from tensegym.validation import page, results
from tensegym.validation.problem import NONE, Problem
from tensegym.validation.problems import PROBLEMS
from tensegym.validation.reasons import reason
from tensegym.validation.row import Findings, Row
from tests.conftest import assert_refused

DOCS = Path(__file__).parents[2] / "docs"
RESULTS = {key: part for key, part in json.loads((DOCS / "validation" / "results.json").read_text()).items()
           if key != "version"}  # fmt: skip
FIGURES = {path.stem: path for path in (DOCS / "validation").glob("*.png")}


def test_the_page_says_what_was_measured():
    assert (DOCS / "validation.md").read_text() == page.page(RESULTS, FIGURES)


def test_every_problem_was_measured_in_every_engine_it_can_be():
    wanted = {f"{name} {engine}".strip() for name, problem in PROBLEMS.items() for engine in problem.engines}
    assert set(RESULTS) == wanted


@pytest.mark.parametrize("key", RESULTS)
def test_what_fails_says_why(key):
    part = RESULTS[key]
    for row in part["rows"]:
        measured = float("inf") if row["measured"] is None else row["measured"]
        assert row["passed"] == (abs(measured - row["expected"]) <= row["tolerance"])
    if not all(row["passed"] for row in part["rows"]):
        assert reason(part["problem"], part["engine"]) != reason("", "")


@pytest.mark.parametrize("key", ["bowling pybullet", "stopping pybullet", "princeton", "wittrick"])
def test_quick_rows_are_still_measured_so(key):
    part = RESULTS[key]
    now = results.measured(part["problem"], part["engine"])["rows"]
    for row, then in zip(now, part["rows"], strict=True):
        assert row["quantity"] == then["quantity"]
        assert row["measured"] == pytest.approx(then["measured"], abs=0.1 * then["tolerance"])


def test_an_engine_that_is_not_installed_is_left_out():
    alone = results.items(("pybullet",))
    assert {engine for _, engine in alone} == {"pybullet", ""}
    assert {name for name, _ in results.items(ENGINES)} - {name for name, _ in alone} == {"sides", "faces"}


def tiny(engine):
    """A problem that a test can wait for."""
    return Findings([Row("tiny", "answer", 42.0, 42.0, 0.0), Row("tiny", "guess", 1.0, 2.0, 0.5, 1e-3, "A guess.")])


@pytest.fixture
def small(monkeypatch):
    calls = []

    def noted(engine):
        calls.append(engine)
        if calls == ["pybullet"]:
            raise KeyboardInterrupt
        return tiny(engine)

    problems = {"still": Problem("Still", "Still", "arithmetic", tiny, NONE, minutes=1),
                "tiny": Problem("Tiny", "Tiny", "arithmetic", noted)}  # fmt: skip
    for module in (results, page):
        monkeypatch.setattr(module, "PROBLEMS", problems)
    return calls


def test_a_run_that_was_stopped_goes_on(small, tmp_path, cli):
    command = "validate", "--page", tmp_path, "--jobs", 1
    with pytest.raises(KeyboardInterrupt):
        cli(*command)
    assert [path.name for path in (tmp_path / "validation" / "parts").iterdir()] == ["still.json"]
    assert not (tmp_path / "validation.md").exists()
    status, out, _ = cli(*command)
    assert status == 0
    assert small == ["pybullet", *ENGINES]
    assert "3 of 6 rows pass" in out
    assert not (tmp_path / "validation" / "parts").exists()
    text = (tmp_path / "validation.md").read_text()
    assert "| guess | 1 | 1 | 0.5 | 2 **✗** | 2 **✗** |" in text
    assert "* PyBullet and MuJoCo: A guess." in text
    assert set(json.loads((tmp_path / "validation" / "results.json").read_text())) == {
        "version", "still", *(f"tiny {engine}" for engine in ENGINES)
    }  # fmt: skip


def test_a_folder_that_is_not_there_is_refused(cli, tmp_path):
    assert_refused(cli("validate", "--page", tmp_path / "nowhere"), "--page", "no such folder")
