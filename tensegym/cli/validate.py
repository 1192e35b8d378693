"""`tensegym validate`: the physics against closed forms."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from tensegym.errors import InputError, SimulationError
from tensegym.files import lock_folder, write_text
from tensegym.plotting import require_matplotlib
from tensegym.report import Report, table
from tensegym.robot.engines import ENGINES, check_engine
from tensegym.validation import TOPICS
from tensegym.validation.setting import setting

from .options import Jobs


@dataclass(frozen=True)
class Validate:
    """Measure the closed-form physics on the running code: expected, measured, tolerance, one row each."""

    engine: str = "pybullet"
    """Physics engine: pybullet, or mujoco (extra mujoco)."""
    page: Path | None = None
    """Folder of validation.md with its figures: measures many more problems in all engines that are installed, for half
    an hour on two cores. A run that was stopped goes on where it was."""
    jobs: Jobs | None = None
    """Processes for the page; default: one a core."""

    def run(self) -> Report:
        check_engine(self.engine)
        if self.page is not None:
            return _write_page(self.page, self.jobs or 0)
        checks = [check for rows_of in TOPICS.values() for check in rows_of(self.engine)]
        lines = [[c.id, c.quantity, f"{c.expected:.7g}", f"{c.measured:.7g}", f"{c.tolerance:.2g}",
                 "pass" if c.passed else "FAIL"] for c in checks]  # fmt: skip
        passed = sum(c.passed for c in checks)
        text = table(["id", "quantity", "expected", "measured", "tolerance", ""], lines)
        text += f"\n{passed} of {len(checks)} pass; {setting(self.engine)}"
        rows = [asdict(c) | {"passed": c.passed} for c in checks]
        data = {"checks": rows, "passed": passed, "total": len(checks), "setting": setting(self.engine)}
        return Report(text, data, passed=passed == len(checks))


def _write_page(folder: Path, jobs: int) -> Report:
    require_matplotlib()
    from tensegym.validation.figures import draw_all
    from tensegym.validation.page import page
    from tensegym.validation.results import as_text, measure_all

    if not folder.is_dir():
        raise InputError(f"--page {folder}: there is no such folder")
    kept = folder / "validation"
    with lock_folder(kept):
        results = measure_all(kept / "parts", tuple(_engines()), jobs)
        write_text(folder / "validation.md", page(results, draw_all(results, kept)))
        write_text(kept / "results.json", as_text(results))
        shutil.rmtree(kept / "parts")
    rows = [row for part in results.values() for row in part["rows"]]
    passed = sum(row["passed"] for row in rows)
    text = f"{folder / 'validation.md'}: {passed} of {len(rows)} rows pass; the others say why"
    return Report(text, {"page": str(folder / "validation.md"), "passed": passed, "total": len(rows)})


def _engines() -> Iterator[str]:
    """Those that are installed."""
    for engine in ENGINES:
        with suppress(SimulationError):
            check_engine(engine)
            yield engine
