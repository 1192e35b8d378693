"""Dataclasses that say what a table may hold: the fields' types, ranges, units and meanings."""

from __future__ import annotations

import types
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import MISSING, Field, dataclass, field, fields, is_dataclass, replace
from functools import cache
from typing import Any, ClassVar, TypeVar, Union, cast, get_args, get_origin, get_type_hints

from tensegym.errors import InputError, TensegymError

from .ranges import Range
from .values import Error, as_number, as_text, as_whole, in_file, known, one_line, show

T = TypeVar("T")


def bounded(
    low: float, high: float, default: Any = MISSING, unit: str = "", what: str = "", *, open_low: bool = False,
    open_high: bool = False,
) -> Any:  # fmt: skip
    """A dataclass field holding a number, or a tuple of numbers, in a range.

    Args:
        low, high: ends of the range; ``open_low`` and ``open_high`` leave them out.
        default: the field's; None where the annotation allows it, left out where the field must be given.
        unit: SI unit, "" for none.
        what: the field's meaning.
    """
    allowed = Range(low, high, open_low=open_low, open_high=open_high)
    return field(default=default, metadata={"range": allowed, "unit": unit, "what": what})


def choice(*allowed: str, default: Any = MISSING, what: str = "") -> Any:
    """A dataclass field holding one of a few texts; the default is the first of them unless given."""
    return field(default=allowed[0] if default is MISSING else default, metadata={"choices": allowed, "what": what})


def noted(default: Any = MISSING, what: str = "") -> Any:
    """A dataclass field without a range (a text, a flag, a group of fields), with its meaning."""
    return field(default=default, metadata={"what": what})


def parsed(read: Callable[[Any], Any], default: Any = MISSING, what: str = "") -> Any:
    """A dataclass field of a type of its own: ``read`` makes it from what a table holds, or raises a TensegymError."""
    return field(default=default, metadata={"read": read, "what": what})


class Checked:
    """Base of dataclasses whose fields are checked on construction; ``error`` in the class line is what is raised."""

    _error: ClassVar[Error] = InputError

    def __init_subclass__(cls, error: Error | None = None, **rest: Any) -> None:
        super().__init_subclass__(**rest)
        if error is not None:
            cls._error = error

    def __post_init__(self) -> None:
        check_fields(self, self._error)


def check_fields(group: Any, error: Error) -> None:
    """Check the type and range of every field of a dataclass, and make floats of whole numbers where floats stand.

    Raises ``error``, naming class and field, the value and what is allowed.
    """
    for f, kind in _declared(type(group)):
        value = getattr(group, f.name)
        checked = _typed(f, kind, value, f"{type(group).__name__}.{f.name}", error)
        if checked is not value:
            object.__setattr__(group, f.name, checked)


def fill(kind: type[T], table: Any, where: str, error: Error, base: T | None = None) -> T:
    """Make a dataclass out of a table.

    Args:
        kind: the dataclass.
        table: what a file gives; fields left out keep those of ``base``, or the defaults.
        where: names the table in messages, as in "elastic_cable"; "" for the whole file.
        error: raised for an unknown, missing, mistyped or out-of-range field, naming it.
        base: what the table changes.
    """
    values = read_fields(kind, table, where, error, base)
    if base is not None:
        with in_file(where) if where else nullcontext():
            return replace(base, **values)  # type: ignore[type-var]
    for f in fields(kind):  # type: ignore[arg-type]
        if f.init and f.name not in values and f.default is MISSING and f.default_factory is MISSING:
            raise error(one_line(f"{where or kind.__name__} has no {f.name!r}; it must be given"))
    with in_file(where) if where else nullcontext():
        return kind(**values)


def read_fields(kind: type[Any], table: Any, where: str, error: Error, base: Any = None) -> dict[str, Any]:
    """The fields that a table gives, checked and of the right types; arguments as of `fill`."""
    declared = {f.name: (f, of) for f, of in _declared(kind) if f.init}
    known(table, declared, where or "the table", error)
    values = {}
    for name, value in table.items():
        f, of = declared[name]
        at = f"{where}.{name}" if where else name
        group = next((k for k in _alternatives(of) if is_dataclass(k)), None)
        if "read" in f.metadata:
            try:
                values[name] = f.metadata["read"](value)
            except TensegymError as fault:
                raise error(one_line(f"{at}: {fault}")) from fault
        elif group is not None and isinstance(value, dict):
            values[name] = fill(cast(type[Any], group), value, at, error, getattr(base, name, None))
        else:
            values[name] = _typed(f, of, value, at, error)
    return values


@dataclass(frozen=True)
class FieldRow:
    """A line of a reference page: a field, its default, unit, range and meaning as texts."""

    field: str
    default: str
    unit: str
    range: str
    meaning: str


def describe(kind: type[Any]) -> list[FieldRow]:
    """What a table of this dataclass may hold, a row a field, as they stand in it."""
    rows = []
    for f, of in _declared(kind):
        meta = f.metadata
        allowed = str(meta["range"]) if "range" in meta else ", ".join(meta.get("choices", ()))
        default = "" if f.default is MISSING and f.default_factory is MISSING else "none"
        if f.default is not MISSING and f.default is not None:
            default = _shown(f.default)
        if f.default_factory is not MISSING or ("read" not in meta and any(map(is_dataclass, _alternatives(of)))):
            default = "see there"
        if bool in _alternatives(of):
            allowed, default = "true, false", default.lower()
        rows.append(FieldRow(f.name, default, meta.get("unit", ""), allowed, meta.get("what", "")))
    return rows


def _shown(default: Any) -> str:
    if isinstance(default, tuple):
        return ", ".join(map(_shown, default)) or "none"
    return f"{default:g}" if isinstance(default, float) else str(default)


def _find_declared(kind: Any) -> tuple[tuple[Field[Any], Any], ...]:
    """Fields of a dataclass with their types."""
    hints = get_type_hints(kind)
    return tuple((f, hints[f.name]) for f in fields(kind))


_declared: Callable[[Any], tuple[tuple[Field[Any], Any], ...]] = cache(_find_declared)


def _alternatives(kind: Any) -> tuple[Any, ...]:
    return get_args(kind) if get_origin(kind) in (Union, types.UnionType) else (kind,)


def _typed(f: Field[Any], kind: Any, value: Any, where: str, error: Error) -> Any:
    """One value, checked against the annotation and the range or choices of its field."""
    kinds = _alternatives(kind)
    if value is None and type(None) in kinds:
        return None
    of = next(k for k in kinds if k is not type(None))
    if get_origin(of) is tuple:
        return _entries(f, get_args(of), value, where, error)
    if of in (float, int):
        return _ranged(f, of, value, where, error)
    if of is str:
        text, choices = as_text(value, where, error), f.metadata.get("choices")
        if choices and text not in choices:
            raise error(one_line(f"{where} = {show(text)} is not one of {', '.join(choices)}"))
        return text
    if of is bool and not isinstance(value, bool):
        raise error(one_line(f"{where} = {show(value)} must be true or false"))
    if is_dataclass(of) and not isinstance(value, cast(type[Any], of)):
        raise error(one_line(f"{where} = {show(value)} must be a table of fields"))
    if get_origin(of) is dict and not isinstance(value, dict):
        raise error(one_line(f"{where} = {show(value)} must be a table"))
    return value


def _ranged(f: Field[Any], kind: type, value: Any, where: str, error: Error) -> Any:
    allowed: Range | None = f.metadata.get("range")
    span = f"{allowed} {f.metadata['unit']}".rstrip() if allowed else ""
    noun = "whole number" if kind is int else "number" if allowed else "finite number"
    read: Callable[..., Any] = as_whole if kind is int else as_number
    wanted = f"one {noun} in {span}" if allowed else f"one {noun}"
    if isinstance(value, list | tuple) and f.metadata.get("what"):
        wanted += f": {f.metadata['what']}"
    number = read(value, where, error, wanted)
    if allowed is not None and number not in allowed:
        raise error(one_line(f"{where} = {show(value)} is outside {span}"))
    return value if isinstance(value, kind) and not isinstance(value, bool) else number


def _entries(f: Field[Any], kinds: tuple[Any, ...], value: Any, where: str, error: Error) -> tuple[Any, ...]:
    """A list as the tuple that the annotation asks for: tuple[X, ...] or one type an entry."""
    if not isinstance(value, list | tuple):
        raise error(one_line(f"{where} = {show(value)} must be a list"))
    if len(kinds) == 2 and kinds[1] is ...:
        kinds = (kinds[0],) * len(value)
    if len(kinds) != len(value):
        raise error(one_line(f"{where} = {show(value)} must be a list of {len(kinds)}"))
    read = tuple(_typed(f, k, v, f"{where}[{i + 1}]", error) for i, (k, v) in enumerate(zip(kinds, value, strict=True)))
    return value if isinstance(value, tuple) and all(a is b for a, b in zip(read, value, strict=True)) else read
