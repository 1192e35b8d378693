"""`tensegym validate`: the physics against closed forms."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from tensegym.report import Report, table
from tensegym.robot.engines import check_engine
from tensegym.validation import TOPICS
from tensegym.validation.setting import setting


@dataclass(frozen=True)
class Validate:
    """Measure the closed-form physics on the running code: expected, measured, tolerance, one row each."""

    engine: str = "pybullet"
    """Physics engine: pybullet, or mujoco (extra mujoco)."""

    def run(self) -> Report:
        check_engine(self.engine)
        checks = [check for rows_of in TOPICS.values() for check in rows_of(self.engine)]
        lines = [[c.id, c.quantity, f"{c.expected:.7g}", f"{c.measured:.7g}", f"{c.tolerance:.2g}",
                 "pass" if c.passed else "FAIL"] for c in checks]  # fmt: skip
        passed = sum(c.passed for c in checks)
        text = table(["id", "quantity", "expected", "measured", "tolerance", ""], lines)
        text += f"\n{passed} of {len(checks)} pass; {setting(self.engine)}"
        rows = [asdict(c) | {"passed": c.passed} for c in checks]
        data = {"checks": rows, "passed": passed, "total": len(checks), "setting": setting(self.engine)}
        return Report(text, data, passed=passed == len(checks))
