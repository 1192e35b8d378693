"""`tensegym modes`: the free modes of a design, and what its prestress does to its rods."""

from __future__ import annotations

from dataclasses import dataclass

from tensegym.design.design_file import as_design
from tensegym.report import Report, table
from tensegym.robot.modes import design_modes
from tensegym.robot.standing import standing_verdict


@dataclass(frozen=True)
class Modes:
    """Frequencies of a design in free flight with how often each occurs, and the compression of its rods."""

    design: str = "six_rod"
    """A preset (six_rod, six_rod_flexible, paper) or a TOML file."""

    def run(self) -> Report:
        design = as_design(self.design)
        groups = design_modes(design).multiplicities()
        text = table(["Hz", "modes"], [[f"{f:.4f}", n] for f, n in groups])
        compression = design.rod_compressions
        rods = []
        for rod, (a, b) in enumerate((design.standing.rods + 1).tolist()):
            split = rod in design.flexible_rods
            rods.append({"rod": f"{a}-{b}", "compression_N": float(compression[rod]),
                         "buckling_N": design.buckling_load(rod) if split else None,
                         "pin_stiffness_N_m_per_rad": design.rod_pins[rod].stiffness if split else None})  # fmt: skip
        text += "\n\n" + table(
            ["rod", "compression N", "buckling N", "pin N m/rad"],
            [[r["rod"], f"{r['compression_N']:.3f}", *("-" if r[k] is None else f"{r[k]:.2f}" for k in (
                "buckling_N", "pin_stiffness_N_m_per_rad"))] for r in rods],
        )  # fmt: skip
        verdict = standing_verdict(design)
        text += f"\n\n{design.name} {verdict.text}"
        return Report(text, {"modes": [{"hz": f, "count": n} for f, n in groups], "rods": rods,
                             "standing": verdict.as_dict()})  # fmt: skip
