"""The validation page: what was measured as a Markdown page with tables."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tensegym.robot.engines import TITLES

from .problem import PYBULLET
from .problems import PROBLEMS
from .reasons import reason
from .results import Results

HEAD = """# Validation: what is measured, beside what should be

Written by `make validate` (`tensegym validate --page docs`); no number on it is typed by hand. Every row is measured on
the running code: in PyBullet, the default engine, and in MuJoCo, from the same bodies, cables and drives. A row passes
where the measured value is within the tolerance of the expected one, the same for both engines; one that does not is
marked **✗**, and the words under its table say why. All numbers are in
[validation/results.json](validation/results.json)."""


def page(results: Results, figures: dict[str, Path]) -> str:
    """The page's text; ``figures`` by problem."""
    return "\n".join([HEAD, "", *_summary(results), *_sections(results, figures)]).rstrip() + "\n"


def _summary(results: Results) -> Iterator[str]:
    yield "| measured on | rows | pass | processor time, minutes |"
    yield "|---|---|---|---|"
    for engine in (*TITLES, ""):
        parts = [part for part in results.values() if part["engine"] == engine]
        if parts:
            rows = [row for part in parts for row in part["rows"]]
            where = parts[0]["setting"] if engine else "finite elements of flexures; both engines, compared"
            yield f"| {where} | {len(rows)} | {sum(row['passed'] for row in rows)} | {_minutes(parts)} |"
    yield ""
    yield from _failures(results)


def _failures(results: Results) -> Iterator[str]:
    """Where to look first."""
    found = [(part, sum(not row["passed"] for row in part["rows"])) for part in results.values()]
    if any(count for _, count in found):
        yield "Rows that do not pass:"
        yield ""
        yield from (f"* {PROBLEMS[part['problem']].title}, {TITLES.get(part['engine'], 'any engine')}: {count} of "
                    f"{len(part['rows'])}" for part, count in found if count)  # fmt: skip
        yield ""


def _minutes(parts: list[dict[str, Any]]) -> str:
    return f"{sum(part['seconds'] for part in parts) / 60:.1f}"


def _sections(results: Results, figures: dict[str, Path]) -> Iterator[str]:
    section = ""
    for name, problem in PROBLEMS.items():
        parts = {part["engine"]: part for part in results.values() if part["problem"] == name}
        if not parts:
            continue
        if problem.section != section:
            section = problem.section
            yield f"## {section}"
            yield ""
        if problem.title != section:
            yield f"### {problem.title}"
            yield ""
        yield " ".join((inspect.getdoc(problem.measure) or "").split())
        yield ""
        alone = " PyBullet alone: a URDF's joints are not in the protocol of engines." * (problem.engines == PYBULLET)
        yield f"Source: {problem.source}.{alone}"
        yield ""
        yield from table(parts)
        yield from notes(name, parts)
        if name in figures:
            yield f"![{problem.title}]({figures[name].parent.name}/{figures[name].name})"
            yield ""


def table(parts: dict[str, dict[str, Any]]) -> Iterator[str]:
    """A row a quantity, a column an engine."""
    titles = [TITLES.get(engine, "measured") for engine in parts]
    yield "| quantity | step, ms | expected | tolerance | " + " | ".join(titles) + " |"
    yield "|---|---|---|---|" + "---|" * len(parts)
    rows = {engine: {(row["quantity"], row["dt"]): row for row in part["rows"]} for engine, part in parts.items()}
    for key in dict.fromkeys(key for each in rows.values() for key in each):
        found = [each.get(key) for each in rows.values()]
        there = [row for row in found if row]
        step = "" if key[1] is None else f"{1e3 * key[1]:g}"
        cells = ["" if row is None else _number(row["measured"]) + ("" if row["passed"] else " **✗**") for row in found]
        yield f"| {key[0]} | {step} | {_both(there, 'expected')} | {_both(there, 'tolerance')} | {' | '.join(cells)} |"
    yield ""


def _both(rows: list[dict[str, Any]], field: str) -> str:
    """The engines' common value, or each one's own."""
    return " / ".join(dict.fromkeys(_number(row[field], 3 if field == "tolerance" else 6) for row in rows))


def _number(value: float | None, digits: int = 6) -> str:
    return "none" if value is None else f"{value:.{digits}g}"


def notes(name: str, parts: dict[str, dict[str, Any]]) -> Iterator[str]:
    """What is to be said about rows, and why those that fail do."""
    said: dict[str, list[str]] = {}
    for engine, part in parts.items():
        texts = [row["note"] for row in part["rows"] if row["note"]]
        texts += [] if all(row["passed"] for row in part["rows"]) else [f"✗ {reason(name, engine)}"]
        for text in texts:
            said.setdefault(text, []).append(TITLES.get(engine, ""))
    lines = [f"* {': '.join(filter(None, (' and '.join(where), text)))}" for text, where in said.items()]
    yield from (*lines, "") if lines else ()
