"""Command lines: every option of every command with odd values, run in this process."""

import contextlib
import dataclasses
import io
import os
import signal
import sys
import typing
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import yaml
from hypothesis import strategies as st

from tests.fuzz import folders

WORDS = ["", " ", "x", "nan", "inf", "-inf", "-1", "0", "0.5", "1e400", "1e-400", "1,5", "1_0", "0x10", "true", "None",
         "\u0661", "-0", "1e", "9" * 5000, "a" * 300, "e\u0301\u202e\U0001f916", "\ud800", "--", "-h", "../..", "/",
         "{}", "[1]", "six_rod", "paper", "rolling", "onboard", "leaf-spring", "roll", "design.toml", "task.toml",
         "config.yaml", "commands.csv", "folder", "loop", "pipe", "locked", "device", "empty", "none/out", "tensegym:x",
         "sqlite:///study.db", "http://127.0.0.1:1", "study", "policy"]  # fmt: skip
QUICK: dict[str, list[str]] = {  # options with which a command takes a second or two
    "roll": ["--episodes", "1"],
    "step": [],
    "simulate": ["--commands", "commands.csv", "--out", "motion.csv"],
    "modes": [],
    "validate": [],
    "train": ["--config", "config.yaml", "--out", "run", "--steps", "10"],
    "evaluate": ["--episodes", "1", "--seconds", "1", "--no-baselines", "--no-half-step", "--no-video", "--jobs", "1"],
    "design run": ["--task", "task.toml", "--budget", "1", "--out", "found"],
    "design resume": ["--folder", "study", "--budget", "3"],
    "design status": ["--folder", "study"],
    "design report": ["--folder", "study", "--episodes", "2"],
}
PATIENCE = 6.0  # s, after which a command line is taken for one that works, and ended as by Ctrl-C


def commands() -> Iterator[tuple[str, list[str]]]:
    """Every command with its options, those of groups of options too."""
    from tensegym.cli.main import COMMANDS

    def within(table: dict[str, tuple[str, str]], prefix: str) -> Iterator[tuple[str, list[str]]]:
        for name, (target, _) in table.items():
            module, attribute = target.split(":")
            found = getattr(import_module(module), attribute)
            if isinstance(found, dict):
                yield from within(found, f"{prefix}{name} ")
            else:
                yield prefix + name, sorted(_options(found)) if dataclasses.is_dataclass(found) else []

    return within(COMMANDS, "")


def _options(command: Any) -> Iterator[str]:
    for field, hint in typing.get_type_hints(command).items():
        if dataclasses.is_dataclass(hint):
            yield from _options(hint)
        else:
            yield "--" + field.replace("_", "-")


def lines() -> st.SearchStrategy[list[str]]:
    """A command, its quick options, and one to three with odd values; the same option may come twice."""

    def of(command: tuple[str, list[str]]) -> st.SearchStrategy[list[str]]:
        name, options = command
        words = st.sampled_from(WORDS)
        odd = st.one_of(
            *3 * [st.tuples(st.sampled_from(options or ["--json"]), words).map(list)],
            st.tuples(st.sampled_from(["--no-such", "--json", "--import", "--help"]), words).map(list),
            st.sampled_from(options or ["--help"]).map(lambda option: [option]),
            words.map(lambda word: [word]),
        )
        return st.lists(odd, min_size=1, max_size=3).map(
            lambda extra: [*name.split(), *QUICK.get(name, []), *(word for each in extra for word in each)]
        )

    return st.sampled_from(list(commands())).flatmap(of)


def furnish(folder: Path) -> None:
    """What command lines name: files, a folder, a loop of links, a pipe, a file that nobody may read, a device."""
    header = "time_s," + ",".join(f"drive_{d}_rad" for d in range(1, 7))
    files = {
        "design.toml": 'preset = "six_rod"\n', "task.toml": folders.TASK, "empty": "", "locked": "x",
        "commands.csv": "\n".join([header, *(f"{t},0,0,0,0,0,0" for t in (0, 0.01, 0.02))]),
        "config.yaml": yaml.safe_dump(folders.CONFIG | {"steps": 10, "chunk": 1, "episode_seconds": 0.5}),
    }  # fmt: skip
    for name, text in files.items():
        (folder / name).write_text(text)
    (folder / "locked").chmod(0)
    (folder / "folder" / "inner").mkdir(parents=True)
    (folder / "loop").symlink_to("loop")
    (folder / "device").symlink_to(os.devnull)
    os.mkfifo(folder / "pipe")
    (folder / "study").mkdir()
    (folder / "study" / "storage.txt").write_text("")
    (folder / "study" / "study.db").write_bytes(folders.study())
    (folder / "policy").mkdir()
    folders.put(folders.policy(), folder / "policy")


class Said(Exception):
    """What a command should not have said or left."""


def run(words: list[str]) -> None:
    """Run a command line; refused lines are of two kinds, this package's and those of the parser of options.

    Raises what the command raises, and Said for a message of several lines that is not the parser's, or a file written
    by a command that was refused.
    """
    from tensegym.cli.main import run as main
    from tensegym.errors import InputError

    before, error = _files(), io.StringIO()
    signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, PATIENCE)
    status: Any = 130
    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(error):
            status = main(words)
    except SystemExit as end:
        status = end.code
        if status == 2:
            raise InputError("the parser of options") from None
    except KeyboardInterrupt:
        pass
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
    said = [line for line in error.getvalue().splitlines() if line.strip() and "it/s" not in line and "%|" not in line]
    if status not in (0, 1, 2, 130):
        raise Said(f"status {status}")
    if status == 2:
        if len(said) != 1 or len(said[0]) > 400:
            raise Said(f"{len(said)} lines: {said[:3]}")
        if new := _files() - before:
            raise Said(f"refused, and wrote {sorted(new)[:3]}")
        raise InputError(said[0])


def _files() -> set[str]:
    """Of the working directory; those of databases come and go."""
    return {str(path) for path in Path(".").rglob("*") if not path.name.endswith(("-wal", "-shm", ".tensegym-lock"))}


def stand_in(folder: Path) -> None:
    """Work in a folder, made as `furnish` does."""
    furnish(folder)
    os.chdir(folder)
    sys.path.insert(0, str(folder))
