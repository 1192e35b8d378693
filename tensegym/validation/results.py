"""Measure all problems of the page over processes; what is done is kept, so that a run that was stopped goes on."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.errors import InputError
from tensegym.files import VERSION, write_json
from tensegym.processes import process_map
from tensegym.report import to_json
from tensegym.tables import read_json

from .problems import PROBLEMS
from .setting import setting

Results = dict[str, dict[str, Any]]
"""Parts by "problem engine": setting, seconds of processor time, rows, curves."""


def measured(name: str, engine: str) -> dict[str, Any]:
    """One problem in one engine, as plain JSON types."""
    began = time.process_time()
    findings = PROBLEMS[name].measure(engine)
    part = {"problem": name, "engine": engine, "setting": setting(engine or "pybullet"),
            "seconds": round(time.process_time() - began, 1),
            "rows": [asdict(row) | {"passed": row.passed} for row in findings.rows],
            "curves": _short(findings.curves)}  # fmt: skip
    return dict(json.loads(to_json(part)))


def _short(value: Any) -> Any:
    """Curves to five digits, which a figure does not show more of."""
    if isinstance(value, dict):
        return {key: _short(part) for key, part in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [_short(part) for part in value]
    return float(f"{value:.5g}") if isinstance(value, float) else value


def _measured(item: tuple[str, str]) -> dict[str, Any]:
    return measured(*item)


def items(engines: tuple[str, ...]) -> list[tuple[str, str]]:
    """Problem and engine of every part, the long ones first."""
    long_first = sorted(PROBLEMS, key=lambda name: -PROBLEMS[name].minutes)
    return [(name, engine) for name in long_first if {*PROBLEMS[name].needs} <= {*engines}
            for engine in PROBLEMS[name].engines if engine in (*engines, "")]  # fmt: skip


def measure_all(folder: Path, engines: tuple[str, ...], jobs: int = 0) -> Results:
    """All parts, those that ``folder`` holds already as they are there; each is kept there as soon as it is done."""
    folder.mkdir(parents=True, exist_ok=True)
    wanted = items(engines)
    done = {key: read_json(_file(folder, key), "part", InputError) for key in wanted if _file(folder, key).is_file()}
    left = [key for key in wanted if key not in done]
    for part in _parts(left, jobs):
        key = part["problem"], part["engine"]
        write_json(_file(folder, key), part)
        done[key] = part
    return {f"{name} {engine}".strip(): done[name, engine] for name in PROBLEMS for engine in PROBLEMS[name].engines
            if (name, engine) in done}  # fmt: skip


def as_text(results: Results) -> str:
    """JSON, a part a line."""
    lines = [f"{json.dumps(key)}: {json.dumps(value)}" for key, value in {"version": VERSION, **results}.items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _parts(left: list[tuple[str, str]], jobs: int) -> Iterator[dict[str, Any]]:
    if left:
        yield from process_map(_measured, left, jobs, bar="validation", unit="problem")


def _file(folder: Path, key: tuple[str, str]) -> Path:
    return folder / f"{'-'.join(filter(None, key))}.json"
