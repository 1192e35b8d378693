"""The reference pages of the documents, made from the program: environments, commands, files, public names.

`make docs` writes them into docs/reference/, which git does not keep.
"""

from __future__ import annotations

import contextlib
import dataclasses
import inspect
import io
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import gymnasium as gym

import tensegym
from tensegym.cli import fields, main
from tensegym.envs import IDS
from tensegym.envs.rolling import RollingEnv
from tensegym.files import write_text

_SECTIONS = {"Args:": "param", "Raises:": "raises", "Attributes:": "ivar", "Returns:": "returns"}


def write_pages(folder: Path) -> None:
    """Write every page that is not as it was."""
    folder.mkdir(exist_ok=True)
    for name, lines in (("environments", environments()), ("commands", commands()), ("files", files()), ("api", api())):
        text = "\n".join(lines) + "\n"
        page = folder / f"{name}.md"
        if not page.is_file() or page.read_text() != text:
            write_text(page, text)


def environments() -> Iterator[str]:
    """A page like those of Gymnasium's own environments, from the registry and the class's docstring."""
    yield "# Environments"
    yield ""
    yield "All are one class, `RollingEnv`, registered by `import tensegym` with these arguments:"
    yield ""
    yield "| id | arguments | action space | observation space | time limit |"
    yield "|---|---|---|---|---|"
    for name, (seconds, arguments) in IDS.items():
        with gym.make(name) as env:
            driven, seen = env.action_space, env.observation_space
            given = ", ".join(f"{key}={value!r}" for key, value in arguments.items())
            yield (f"| `{name}` | `{given}` | `Box(-1, 1, {driven.shape}, float32)` | `Box({seen.shape}, float32)` | "
                   f"{seconds:g} s, {env.spec.max_episode_steps} steps |")  # fmt: skip
    yield from ["", "```python", "import gymnasium as gym", "import tensegym", ""]
    yield from [f'env = gym.make("{next(iter(IDS))}")', "```", ""]
    yield "## RollingEnv"
    yield ""
    yield from inspect.cleandoc(RollingEnv.__doc__ or "").splitlines()
    yield from ["", "### Arguments and their defaults", "", "| argument | default |", "|---|---|"]
    for parameter in list(inspect.signature(RollingEnv).parameters.values()):
        yield f"| `{parameter.name}` | `{parameter.default!r}` |"


def commands() -> Iterator[str]:
    """Every command with what its --help prints."""
    yield "# Commands"
    yield ""
    yield from _block(_help([]))
    yield from _commands_of(main.COMMANDS, [])


def _commands_of(group: dict[str, tuple[str, str]], above: list[str]) -> Iterator[str]:
    for name, (target, what) in group.items():
        words = [*above, name]
        yield from [f"{'#' * (len(words) + 1)} tensegym {' '.join(words)}", "", f"{what[0].upper()}{what[1:]}.", ""]
        found = main._load(target)
        if isinstance(found, dict):
            yield from _commands_of(found, words)
        else:
            yield from _block(_help(words))


def _help(words: list[str]) -> str:
    shown = io.StringIO()
    os.environ["COLUMNS"] = "100"
    with contextlib.redirect_stdout(shown), contextlib.suppress(SystemExit):
        main.run([*words, "--help"])
    return shown.getvalue()


def _block(text: str) -> list[str]:
    return ["```text", *(line.rstrip() for line in text.rstrip().splitlines()), "```", ""]


def files() -> Iterator[str]:
    """What each kind of file may hold."""
    yield "# Files"
    yield ""
    yield "What each kind of file may hold, as its reader checks it; `tensegym fields KIND` prints the same."
    yield ""
    for name, kind in fields.FILES.items():
        yield from [f"## {name}", "", f"{kind.what[0].upper()}{kind.what[1:]}.", "", *_block(fields.example(name))]
        for section in fields.sections(name):
            rows = fields.rows(section)
            if not rows:
                continue
            if section.title:
                yield from [f"### `[{section.title}]`", ""]
            yield from ["| " + " | ".join(fields.HEADER) + " |", "|" + "---|" * len(fields.HEADER)]
            for row in rows:
                cells = [value.replace("|", "\\|") for value in dataclasses.asdict(row).values()]
                yield f"| `{cells[0]}` | " + " | ".join(cells[1:]) + " |"
            yield ""


def api() -> Iterator[str]:
    """The names of `tensegym`, and what their docstrings say."""
    yield "# Python"
    yield ""
    yield "What `import tensegym` offers. Everything is in SI units; a name is imported when it is first asked for."
    yield ""
    groups: dict[str, list[str]] = {}
    for name in tensegym.__all__:
        shelf = getattr(tensegym, name).__module__.split(".")[1]
        groups.setdefault(shelf, []).append(name)
    for shelf, names in groups.items():
        yield from [f"## tensegym.{shelf}", ""]
        for name in names:
            yield from _entry(name, getattr(tensegym, name))


def _entry(name: str, thing: Any) -> Iterator[str]:
    if not inspect.isclass(thing):
        yield from _directive("function", f"{name}{_signature(thing)}", _docstring(thing))
        return
    error = issubclass(thing, Exception)
    yield from _directive("exception" if error else "class", name if error else f"{name}{_signature(thing)}",
                          _docstring(thing), None if error else list(_members(thing)))  # fmt: skip


def _members(kind: type[Any]) -> Iterator[str]:
    """Documented methods and properties of its own and of the package's classes that it comes from."""
    for name, member in inspect.getmembers(kind):
        of = inspect.unwrap(member.fget if isinstance(member, property) else getattr(member, "func", member))
        if name.startswith("_") or not str(getattr(of, "__module__", "")).startswith("tensegym"):
            continue
        doc = _docstring(of)
        if not doc or inspect.isclass(of):
            continue
        if isinstance(member, property) or not inspect.isroutine(member):
            yield from _directive("property", name, doc)
        else:
            first = inspect.signature(of)
            bound = first.replace(parameters=list(first.parameters.values())[not inspect.ismethod(member):])
            yield from _directive("method", f"{name}{_signature(of, bound)}", doc)


def _directive(kind: str, signature: str, doc: list[str], members: list[str] | None = None) -> Iterator[str]:
    fence = "::::" if members is None else "::::::"
    yield from [f"{fence}{{py:{kind}}} {signature}", "", *doc, "", *(members or []), fence, ""]


def _signature(thing: Any, signature: inspect.Signature | None = None) -> str:
    """With names of types as the source has them, less defaults that say nothing in print."""
    try:
        signature = signature or inspect.signature(thing)
    except ValueError:
        return "()"
    parameters = [
        parameter.replace(default=..., annotation=parameter.annotation)
        if parameter.default is not parameter.empty and not isinstance(parameter.default, str | int | float | None)
        else parameter
        for parameter in signature.parameters.values()
    ]
    text = str(signature.replace(parameters=parameters))
    text = re.sub(r"<[^>]*>|tensegym(\.\w+)*\.(?=\w)", lambda m: "..." if m[0].startswith("<") else "", text)
    return text.replace("'", "").replace("Ellipsis", "...").replace("NDArray[np.float32]", "ndarray")


def _docstring(thing: Any) -> list[str]:
    """As Markdown: sections of arguments and errors become field lists."""
    lines, section, out = inspect.cleandoc(inspect.getdoc(thing) or "").splitlines(), "", list[str]()
    for line in lines:
        if line in _SECTIONS:
            section = _SECTIONS[line]
            out.append("")
        elif section and re.match(r"    [\w, .*]+:", line):
            name, _, text = line.strip().partition(":")
            out.append(f":{section} {name}:{text}" if section != "returns" else f":returns: {line.strip()}")
        elif section and line.startswith("    "):
            out.append(f"    {line.strip()}")
        else:
            section = "" if line and not line.startswith(" ") else section
            out.append(line)
    return out


if __name__ == "__main__":
    write_pages(Path(__file__).parent / "reference")
