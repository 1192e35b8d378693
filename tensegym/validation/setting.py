"""What the rows were measured on: Python, the engine, and whether substeps run compiled."""

from __future__ import annotations

import platform
from importlib.metadata import version

from tensegym.bullet import c_interface


def setting(engine: str = "pybullet") -> str:
    """One line on this process, as "Python 3.13.0, pybullet-arm64 3.2.8, compiled substeps"."""
    if engine != "pybullet":
        return f"Python {platform.python_version()}, {engine} {version(engine)}"
    engine = " ".join(f"{name} {number}" for name, number in c_interface.installed().items()) or "PyBullet"
    loop = "compiled substeps" if c_interface.AVAILABLE else (
        f"substeps by Python's calls, to the same bits in more time (compiled ones know {c_interface.known_names()})")
    return f"Python {platform.python_version()}, {engine}, {loop}"
