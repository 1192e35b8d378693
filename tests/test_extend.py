"""docs/extend.md: its files and its code, as a reader would put them into a folder and run them."""

import re
import subprocess
import sys
from pathlib import Path

TEXT = (Path(__file__).parents[1] / "docs" / "extend.md").read_text()
BLOCKS = re.findall(r"```(\w+)(?: file=(\S+))?\n(.*?)```", TEXT, re.DOTALL)


def run(folder, *arguments):
    done = subprocess.run([sys.executable, *arguments], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_worked_example_runs(tmp_path):
    for _, name, text in BLOCKS:
        if name:
            (tmp_path / name).write_text(text)
    scripts = [text for language, name, text in BLOCKS if language == "python" and not name]
    assert len(scripts) == 2
    printed = [run(tmp_path, "-c", script) for script in scripts]
    assert "energy" in printed[0] and "left the circle" in printed[1]
    run(tmp_path, "-m", "tensegym", "design", "run", "--task", "leave.toml", "--out", "found", "--budget", "3")
    status = ["-m", "tensegym", "design", "status", "--folder", "found", "--json"]
    assert '"trials": 3' in run(tmp_path, *status, "--import", "leave")
    refused = subprocess.run([sys.executable, *status], cwd=tmp_path, capture_output=True, text=True)
    assert refused.returncode == 2 and "'leave:Leave', which is code" in refused.stderr


def test_the_example_is_as_short_as_it_says():
    (task,) = (text for _, name, text in BLOCKS if name == "leave.py")
    assert len(task.splitlines()) < 60
