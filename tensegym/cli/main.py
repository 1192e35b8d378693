"""`tensegym COMMAND`: parses one command, runs it, prints its table or its JSON object.

A command is a dataclass (its fields are the options) with ``run() -> Report``. Only the module of the chosen
command is imported, so `tensegym --help` stays fast and `tensegym simulate` never imports torch.
"""

from __future__ import annotations

import gc
import importlib
import signal
import sys
import threading
from typing import Any

from tensegym.errors import InputError, TensegymError, one_line
from tensegym.report import Report, to_json

COMMANDS: dict[str, tuple[str, str]] = {
    # name: ("module:Class" or "module:COMMANDS" for a group, one line of help)
    "roll": ("tensegym.cli.roll:Roll", "watch the shipped policy roll: table, metrics.json, gait.png, roll.mp4"),
    "step": ("tensegym.cli.step:Step", "tip from one face onto the next; --all-faces: which pull tips which face"),
    "simulate": ("tensegym.cli.simulate:Simulate", "drive-angle commands in, the whole motion out, as CSV"),
    "modes": ("tensegym.cli.modes:Modes", "free modes of a design, and the loads of its rods"),
    "build": ("tensegym.cli.build:Build", "a prism, tower, truncated solid or another structure as a design file"),
    "import": ("tensegym.cli.import_:Import", "an NTRT model, or nodes and connectivity as CSV, as a design file"),
    "export": ("tensegym.cli.export:Export", "a design as MJCF, with tendons and winches, URDF, NTRT's YAML, or CSV"),
    "compare": ("tensegym.cli.compare:Compare", "PyBullet and MuJoCo side by side: flight, rest, steps, a policy"),
    "validate": ("tensegym.cli.validate:Validate", "physics against closed forms: expected, measured, tolerance"),
    "view": ("tensegym.cli.view:View", "the robot in a browser: look, drive, click a place to go to"),
    "train": ("tensegym.cli.train:Train", "train a rolling policy with PPO; resumable"),
    "evaluate": ("tensegym.cli.evaluate:Evaluate", "judge a policy and the baselines over many seeds"),
    "policy": ("tensegym.cli.policy:COMMANDS", "a policy for a robot's own computer: export"),
    "design": ("tensegym.cli.design:COMMANDS", "search for a design that makes a motion: run, resume, status"),
    "fields": ("tensegym.cli.fields:Fields", "what a design, task, training or other file may hold: units, ranges"),
    "flexure": ("tensegym.cli.flexure:COMMANDS", "flexible joints: table, fit, solve, travel, guide, ..."),
}
EXTRAS = {"optuna": "search", "cmaes": "search", "sqlalchemy": "search", "ray": "cluster", "onnx": "onnx",
          "viser": "view", "trimesh": "view"}  # fmt: skip


def usage(commands: dict[str, tuple[str, str]], program: str) -> str:
    width = max(map(len, commands), default=0)
    rows = [f"  {name:<{width}}  {text}" for name, (_, text) in commands.items()]
    tail = (f"`{program} COMMAND --help` lists its options; every command takes --json, and --import MODULE where a "
            "folder names a task of your own.")  # fmt: skip
    return "\n".join([f"usage: {program} COMMAND [options]", "", "commands:", *rows, "", tail])


def _load(target: str) -> Any:
    module, name = target.split(":")
    return getattr(importlib.import_module(module), name)


def run(argv: list[str], commands: dict[str, tuple[str, str]] = COMMANDS, program: str = "tensegym") -> int:
    """Run one command line; returns the exit status (0 fine, 1 a check failed, 2 bad input)."""
    if not argv or argv[0] in ("-h", "--help"):
        print(usage(commands, program))
        return 0 if argv else 2
    if argv[0] == "--version":
        from tensegym import __version__

        print(__version__)
        return 0
    name, rest = argv[0], argv[1:]
    if name not in commands:
        print(f"{program}: error: unknown command {name!r}; one of: {', '.join(commands)}", file=sys.stderr)
        return 2
    try:
        target = _load(commands[name][0])
        if isinstance(target, dict):
            return run(rest, target, f"{program} {name}")

        import tyro

        from .options import check_ranges

        words, as_json = _common(rest)
        command = tyro.cli(target, args=words, prog=f"{program} {name} [--json]", config=(tyro.conf.OmitArgPrefixes,))
        check_ranges(command)
        report: Report = command.run()
    except ModuleNotFoundError as error:
        if str(error.name).startswith("tensegym"):
            raise
        extra = EXTRAS.get(str(error.name).split(".")[0], "train")
        print(f"{program} {name}: error: {error.name} is not installed; it comes with the extra {extra}: "
              f"pip install '.[{extra}]' in tensegym's sources", file=sys.stderr)  # fmt: skip
        return 2
    except BrokenPipeError:
        raise
    except (TensegymError, OSError, UnicodeDecodeError) as error:
        print(f"{program} {name}: error: {one_line(str(error))}", file=sys.stderr)
        return 2
    print(to_json(report.data) if as_json else report.text)
    return 0 if report.passed else 1


def _common(words: list[str]) -> tuple[list[str], bool]:
    """Words less the options of all commands, and whether to print JSON; imports what --import names."""
    left, rest = list[str](), iter(words)
    for word in rest:
        if word == "--import":
            _import(next(rest, ""))
        elif word != "--json":
            left.append(word)
    return left, "--json" in words


def _import(module: str) -> None:
    try:
        importlib.import_module(module)
    except Exception as error:  # of a module that is anyone's
        raise InputError(f"--import {module!r}: {type(error).__name__}: {error}") from error


class _Terminated(KeyboardInterrupt):
    """SIGTERM, which ends a command as Ctrl-C does: workers first, files whole."""


def _terminate(*_: object) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # a second one does not wait
    raise _Terminated


def _again(swallowed: Any) -> None:
    """Interrupt once more where a library's callback swallowed it, as the compiler's do."""
    if not isinstance(swallowed.exc_value, KeyboardInterrupt):
        sys.__unraisablehook__(swallowed)
        return
    how = signal.SIGINT
    if isinstance(swallowed.exc_value, _Terminated):
        signal.signal(signal.SIGTERM, _terminate)
        how = signal.SIGTERM
    soon = threading.Timer(0.05, _signal_main, [how])  # when the callback has returned
    soon.daemon = True
    soon.start()


def _signal_main(how: int) -> None:
    if sys.platform == "win32":
        signal.raise_signal(how)
    else:  # which also wakes it where it waits
        signal.pthread_kill(threading.main_thread().ident or 0, how)


def main() -> None:
    signal.signal(signal.SIGTERM, _terminate)
    sys.unraisablehook = _again
    try:
        status = run(sys.argv[1:])
    except _Terminated:
        status = 143
    except KeyboardInterrupt:
        status = 130
    except (SystemError, ImportError) as error:  # what compiled code, or a library's start, makes of an interrupt
        if not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        status = 143 if isinstance(error.__cause__, _Terminated) else 130
    except BrokenPipeError:
        status = 0
    gc.freeze()  # else Python looks through all that torch and numba hold once more as it ends, for seconds
    sys.exit(status)
