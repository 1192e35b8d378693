"""Tutorials: their files, commands and code, in the order of the page, as a reader would type them."""

import re
import shlex
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[1] / "docs" / "tutorials"
PAGES = [*sorted(FOLDER.glob("*.md")), FOLDER.parent / "replays.md"]
QUICK = {  # what a command gets besides, so that its work takes seconds; everything else is as it is printed
    "tensegym train": ["--steps", "20"], "tensegym roll": ["--episodes", "1", "--no-video"],
    "tensegym evaluate": ["--episodes", "2", "--seconds", "1", "--no-half-step", "--no-video", "--jobs", "1"],
    "tensegym design run": ["--budget", "2", "--jobs", "1"],
    "tensegym design report": ["--episodes", "2", "--jobs", "1"],
}  # fmt: skip
SHORT = {"rollout: 50": "rollout: 10", "n_envs: 8": "n_envs: 2", "batch_size: 100": "batch_size: 10",
         "episode_seconds: 20.0": "episode_seconds: 2.0"}  # fmt: skip
ELSEWHERE = ("python3 -m venv", ".venv/bin/", "source ", "git clone", "make ", "cd ")  # timed by hand


def blocks(page):
    return re.findall(r"^```(\w+)(?: file=(\S+))?\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE)


def quick(words):
    for command, more in QUICK.items():
        if words[: len(command.split())] == command.split():
            return [*words, *more]
    return words


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_tutorial_runs_from_top_to_bottom(page, tmp_path, monkeypatch, cli, capsys):
    monkeypatch.chdir(tmp_path)
    names = {}
    for language, name, text in blocks(page):
        if name:
            for old, new in SHORT.items():
                text = text.replace(old, new) if name.endswith(".yaml") else text
            Path(name).write_text(text)
        elif language == "sh":
            for line in filter(None, text.splitlines()):
                run_line(line, cli)
        elif language == "python":
            text = re.sub(r"^(    )?model\.learn\(.*", r"\1", text, flags=re.MULTILINE)
            exec(compile(text, page.name, "exec"), names)


def run_line(line, cli):
    if line.startswith(ELSEWHERE):
        return
    words = shlex.split(line, comments=True)
    if words[:2] == ["python", "-m"]:
        assert words[2] == "tensegym.train.convert"
        from tensegym.train.convert import Convert

        Convert(Path(words[4]), trust="--trust" in words)()
        return
    assert words[0] == "tensegym", line
    status, _, err = cli(*quick(words)[1:])
    assert status == 0, (line, err)


def test_what_is_made_quick_is_there():
    """No entry outlives the line it was for, and every page has code that is run."""
    text = "".join(page.read_text() for page in PAGES)
    assert [command for command in (*QUICK, *SHORT) if command not in text] == []
    assert all(any(language in ("python", "sh") for language, _, _ in blocks(page)) for page in PAGES)
