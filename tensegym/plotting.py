"""Figures for files: matplotlib without a window, imported when the first figure is made."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

from tensegym.files import replace_path

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""Told apart by the colour-blind too: Okabe and Ito 2008."""
MARKERS = ("o", "^", "s", "D", "v", "P", "X")


def require_matplotlib() -> None:
    """Raise ModuleNotFoundError now, before a command has worked or written anything, where nothing can be drawn."""
    import matplotlib  # noqa: F401


def new_figure(
    rows: int = 1, columns: int = 1, *, size: tuple[float, float],
    layout: Literal["constrained", "tight"] = "constrained", **options: Any,
) -> tuple[Any, Any]:  # fmt: skip
    """A figure and its axes: one, (n,) or (rows, columns) of them, as ``Figure.subplots`` squeezes.

    The figure belongs to no window and to no list of open figures, so nothing has to be closed.

    Args:
        rows, columns: of axes.
        size: width and height [inch].
        layout: constrained or tight.
        options: for ``Figure.subplots`` (sharex, squeeze, ...).

    Raises:
        ModuleNotFoundError: without matplotlib.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout=layout)
    axes = figure.subplots(rows, columns, **options)
    for axis in figure.axes:
        axis.grid(color="0.9", lw=0.8)
        axis.set_axisbelow(True)
        for side in ("top", "right"):
            axis.spines[side].set_visible(False)
    return figure, axes


def thin_legend(axis: Any, columns: int = 1, loc: str = "best") -> None:
    """A legend whose lines can be told apart, and through which the curves behind it can be seen."""
    legend = axis.legend(ncols=columns, loc=loc, fontsize="small", framealpha=0.85)
    for line in legend.get_lines():
        line.set_linewidth(max(1.5, line.get_linewidth()))


def save(figure: Any, path: Path, dpi: int = 110) -> None:
    """Write the figure in the format that the name of ``path`` ends in; the file is whole or not there."""
    with replace_path(path) as fresh:
        figure.savefig(fresh, dpi=dpi, format=path.suffix[1:] or "png")


def save_pixels(pixels: Any, path: Path) -> None:
    """Write a picture (height, width, 3), uint8, as it is; the file is whole or not there."""
    require_matplotlib()
    from matplotlib.image import imsave

    with replace_path(path) as fresh:
        imsave(fresh, pixels)
