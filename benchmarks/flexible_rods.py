"""What flexible rods cost: a substep of the robot with three split rods beside the rigid one's, and where it goes.

Both roll under the same random commands, block by block in turn. Seconds are those of this thread's processor time.
"""

from __future__ import annotations

from collections.abc import Iterator

from substep import Rolling
from timing import Row, in_turn, row

from tensegym.design.design import RobotDesign, flexible_design

UNIT = "us a substep"


def rows(rounds: int) -> Iterator[Row]:
    """Ratios at the environments' 2 ms: whole substep, the engine's step, the rest (states, kernel, forces)."""
    robots = {"rigid": Rolling(RobotDesign(), 2e-3), "flexible": Rolling(flexible_design(), 2e-3)}
    contestants = {}
    for name, rolling in robots.items():
        contestants[f"{name} substep"] = rolling.substep
        contestants[f"{name} python"] = rolling.python_loop
        contestants[f"{name} engine"] = rolling.bare_step
    try:
        seen = in_turn(contestants, rounds)
    finally:
        for rolling in robots.values():
            rolling.close()
    for name in robots:
        pairs = zip(seen[f"{name} substep"], seen[f"{name} engine"], strict=True)
        seen[f"{name} rest"] = [whole - engine for whole, engine in pairs]
    parts = {"substep": "substep", "engine": "stepSimulation in it", "rest": "states, kernel and forces"}
    for part, what in parts.items():
        yield row(f"flexible / rigid rods: {what}", seen[f"flexible {part}"], seen[f"rigid {part}"], UNIT)
