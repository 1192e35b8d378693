"""Tables of tips and of holds by name or by file, each read once a process, and the robots that they were made for."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from tensegym.tables import one_line, show

from .hold import Hold, load_holds
from .made_for import MadeFor, read_made_for
from .policy import shipped
from .tipping import Tip
from .walker import load_table

TIPS = {"": "tips", "six_rod": "tips", "three_rod_robot": "three_rod_robot"}  # tables that ship, by the robot's name


@cache
def tips_of(name: str) -> tuple[list[Tip], MadeFor | None]:
    """A table of tips: one that ships by its robot's name, the default design's where that is empty, or a file.

    Raises FileNotFoundError saying which there are, or InputError where a file is none.
    """
    if name not in TIPS and Path(name).suffix != ".json":
        known = ", ".join(name for name in TIPS if name)
        raise FileNotFoundError(one_line(
            f"no table of tips {show(name)}: shipped are {known}; 'own' makes the robot's, and so does `tensegym step "
            "--all-faces --design FILE --out DIR`, to be given as DIR/tips.json"
        ))  # fmt: skip
    path = shipped("walker") / f"{TIPS[name]}.json" if name in TIPS else Path(name)
    return load_table(path), read_made_for(path)


@cache
def holds_of(name: str) -> tuple[list[Hold], MadeFor | None]:
    """A table of holds from a file; the default design's where the name is empty. Raises as `tips_of`."""
    path = Path(name) if name else shipped("walker") / "holds.json"
    return load_holds(path), read_made_for(path)
