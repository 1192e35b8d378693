"""Learning curves: curve.csv of a run, and curves as a picture."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from tensegym.errors import InputError
from tensegym.plotting import COLOURS, MARKERS, new_figure, save, thin_legend
from tensegym.tables import Rows, one_line, read_rows, show

CURVE = "curve.csv"
FIELDS = ("steps", "hours", "episodes", "speed_lps", "speed_lps_p10", "slip_share", "tips", "audit_excess",
          "action_std", "goal")  # fmt: skip
_WITHOUT_GOAL = FIELDS[:-1]  # as runs of before have it


def read_cells(path: Path) -> Rows:
    """curve.csv as texts, FIELDS its header. Raises InputError naming the line, or FileNotFoundError."""
    rows = read_rows(path, least=0)
    if tuple(rows.header) == _WITHOUT_GOAL:
        rows = Rows(list(FIELDS), [[*row, "nan"] for row in rows.cells], rows.lines)
    if tuple(rows.header) != FIELDS:
        raise InputError(one_line(f"{path}: the header must be {','.join(FIELDS)}; found {','.join(rows.header)}"))
    for line, row in zip(rows.lines, rows.cells, strict=True):
        for name, cell in zip(FIELDS, row, strict=True):
            try:
                float(cell)  # nan may stand there: what a diverged episode was worth
            except ValueError:
                raise InputError(one_line(f"{path}, line {line}: {name} = {show(cell)} is no number")) from None
    return rows


def read_curve(path: Path) -> list[dict[str, float]]:
    """A row an update. Raises as `read_cells`."""
    return [dict(zip(FIELDS, map(float, row), strict=True)) for row in read_cells(path).cells]


def draw_curve(runs: Mapping[str, Path], out: Path) -> None:
    """One line a run: median speed of the training episodes against environment steps; slip share below it."""
    figure, (top, bottom) = new_figure(2, size=(7, 6), sharex=True)
    for n, (name, path) in enumerate(runs.items()):
        rows = read_curve(path)
        steps = [row["steps"] / 1000 for row in rows]
        look = {"color": COLOURS[n % len(COLOURS)], "marker": MARKERS[n % len(MARKERS)], "markevery": 5, "ms": 4}
        top.plot(steps, [row["speed_lps"] for row in rows], label=name, **look)
        bottom.plot(steps, [row["slip_share"] for row in rows], **look)
    top.set_ylabel("speed along the heading [rod lengths/s]")
    bottom.set(ylabel="slip, share of the way", xlabel="environment steps [thousand]")
    top.set_title("Median over the episodes of each chunk, exploration noise on")
    thin_legend(top)
    save(figure, out, dpi=120)
