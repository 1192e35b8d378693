"""TOML and YAML files as plain tables: whatever is wrong with one ends in one line that names file, line and column."""

from __future__ import annotations

import codecs
import json
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from tensegym.files import without_version

from .values import Error, mapping, one_line

LARGEST_FILE = 4_000_000  # bytes
_WIDE = {  # UTF-32 first: its mark begins with that of UTF-16
    codecs.BOM_UTF32_LE: "UTF-32", codecs.BOM_UTF32_BE: "UTF-32",
    codecs.BOM_UTF16_LE: "UTF-16", codecs.BOM_UTF16_BE: "UTF-16",
}  # fmt: skip


def read_text(path: str | Path, what: str, error: Error, limit: int = LARGEST_FILE) -> str:
    """The text of a file.

    Args:
        path: of the file.
        what: kind of file, for messages, as in "design file".
        error: raised for a file too large or not in UTF-8.
        limit: largest size [bytes].

    Raises:
        FileNotFoundError: there is no such file.
    """
    path = Path(path)
    try:
        if path.is_dir():
            raise FileNotFoundError(one_line(f"{path} is a folder; give a {what}, a file"))
        if not path.is_file():
            raise FileNotFoundError(one_line(f"no {what} {path}"))
        with path.open("rb") as file:
            data = file.read(limit + 1)
    except (ValueError, PermissionError) as fault:  # a null in the name; no right to read
        raise error(one_line(f"{what} {str(path)!r} cannot be read: {fault}")) from fault
    if len(data) > limit:
        raise error(one_line(f"{what} {path} is larger than {limit / 1e6:g} MB; it is none"))
    return decode(data, f"{what} {path}", error)


def decode(data: bytes, name: str, error: Error) -> str:
    """UTF-8 text, with or without a byte order mark. Raises ``error`` with ``name``, line and column."""
    for mark, coding in _WIDE.items():
        if data.startswith(mark):
            raise error(one_line(f"{name} is written in {coding}; save it as UTF-8"))
    if b"\0" in data[:4]:  # the first characters of a table are ASCII
        raise error(one_line(f"{name} holds null bytes, as UTF-16 without a mark does; save it as UTF-8"))
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        before = data[: fault.start]
        line, column = before.count(b"\n") + 1, fault.start - before.rfind(b"\n")
        raise error(one_line(
            f"{name} is not UTF-8: byte 0x{data[fault.start]:02x} at line {line}, column {column}; save it as UTF-8"
        )) from fault  # fmt: skip


def parse_toml(text: str, name: str, error: Error) -> dict[str, Any]:
    """Tables of a TOML text. Raises ``error`` naming the file by ``name``, with line and column."""
    try:
        return tomllib.loads(text.removeprefix("\ufeff"))
    except tomllib.TOMLDecodeError as fault:
        raise error(one_line(f"{name} is not TOML: {fault}")) from fault
    except RecursionError as fault:
        raise error(one_line(f"{name} is not read: its brackets are nested too deep")) from fault
    except ValueError as fault:  # more digits than Python converts; a date that no calendar has
        raise error(one_line(f"{name} is not read: {_reason(fault)}")) from fault


def parse_yaml(text: str, name: str, error: Error) -> dict[str, Any]:
    """Fields of a YAML text, {} for an empty one; dates stay texts, aliases, tags and repeated fields are refused.

    Raises ``error`` naming the file by ``name``, with line and column.
    """
    import yaml

    try:
        data = yaml.load(text.removeprefix("\ufeff"), Loader=_loader())
    except yaml.YAMLError as fault:
        mark = getattr(fault, "problem_mark", None)
        place = f" at line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        reason = getattr(fault, "problem", None) or str(fault)
        raise error(one_line(f"{name} is not YAML: {reason}{place}")) from fault
    except RecursionError as fault:
        raise error(one_line(f"{name} is not read: its brackets are nested too deep")) from fault
    except (ValueError, TypeError) as fault:  # more digits than Python converts
        raise error(one_line(f"{name} is not read: {_reason(fault)}")) from fault
    return {} if data is None else mapping(data, name, error)


def parse_json(text: str, name: str, error: Error) -> Any:
    """What a JSON text says. Raises ``error`` naming the file by ``name``, with line and column."""
    try:
        return json.loads(text)
    except RecursionError as fault:
        raise error(one_line(f"{name} is not read: its brackets are nested too deep")) from fault
    except ValueError as fault:  # a number of more digits than Python converts is one too
        raise error(one_line(f"{name} is not JSON, or cut short: {_reason(fault)}")) from fault


def read_json(path: str | Path, what: str, error: Error) -> Any:
    """What `tensegym.files.write_json` wrote, or, as before files had versions, any JSON.

    Raises FileNotFoundError, or ``error`` naming ``what`` and the path: no JSON, or newer than this program.
    """
    data = parse_json(read_text(path, what, error), f"{what} {path}", error)
    return without_version(data, path) if isinstance(data, dict) else data


def read_toml(path: str | Path, what: str, error: Error) -> dict[str, Any]:
    """Tables of a TOML file. Raises FileNotFoundError, or ``error`` naming ``what`` and the path."""
    return parse_toml(read_text(path, what, error), f"{what} {path}", error)


def read_yaml(path: str | Path, what: str, error: Error) -> dict[str, Any]:
    """Fields of a YAML file. Raises FileNotFoundError, or ``error`` naming ``what`` and the path."""
    return parse_yaml(read_text(path, what, error), f"{what} {path}", error)


def _reason(fault: Exception) -> str:
    """What Python says is wrong, without its advice to change a setting of the interpreter."""
    return str(fault).partition("; use sys.")[0]


@cache
def _loader() -> Any:
    """yaml's safe loader without dates, aliases, tags and repeated keys; made when asked for, as yaml is optional."""
    import yaml

    class Loader(yaml.SafeLoader):  # type: ignore[misc]
        yaml_implicit_resolvers = {  # noqa: RUF012
            first: [(tag, pattern) for tag, pattern in resolvers if tag != "tag:yaml.org,2002:timestamp"]
            for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
        }

        def compose_node(self, parent: Any, index: Any) -> Any:
            if self.check_event(yaml.AliasEvent):
                mark = self.peek_event().start_mark
                raise yaml.composer.ComposerError(None, None, "an alias (*name) stands there; write it out", mark)
            event = self.peek_event()
            if event.tag is not None:  # yaml's constructors raise errors of every kind for what a tag does not fit
                reason = "a tag (!!type) stands there; leave it out"
                raise yaml.composer.ComposerError(None, None, reason, event.start_mark)
            return super().compose_node(parent, index)

        def construct_mapping(self, node: Any, deep: bool = False) -> Any:
            seen = set()
            for key, _ in node.value:
                if key.value in seen if isinstance(key.value, str) else False:
                    raise yaml.constructor.ConstructorError(
                        None, None, f"the field {key.value[:60]!r} is given twice", key.start_mark)
                seen.add(key.value if isinstance(key.value, str) else None)
            return super().construct_mapping(node, deep)

    return Loader
