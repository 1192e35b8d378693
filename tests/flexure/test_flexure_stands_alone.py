"""The flexure shelf needs numpy, scipy, numba and five small modules of tensegym; its parts import one way."""

import subprocess
import sys

import pytest

SHELVES = ("hinge", "fem", "models", "measured")
OF_TENSEGYM = {"arrays", "errors", "files", "tables", "report", "compiled", "flexure"}

LOADED = """
import pkgutil, sys
import tensegym
before = set(sys.modules)
import tensegym.flexure
from importlib import import_module
for part in {parts}:
    package = import_module("tensegym.flexure." + part)
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        import_module(module.name)
print(*sorted(set(sys.modules) - before))
"""


def loaded(*parts):
    """Modules that these parts of the shelf bring, all of their files imported in a process of its own."""
    code = LOADED.format(parts=parts)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_the_shelf_needs_nothing_but_numbers():
    names = loaded(*SHELVES)
    own = {name.split(".")[1] for name in names if name.startswith("tensegym.")}
    assert own - OF_TENSEGYM == set()
    assert not {name.split(".")[0] for name in names} & {"pybullet", "matplotlib", "PIL", "torch", "tyro"}
    assert "numba" in {name.split(".")[0] for name in names}


@pytest.mark.parametrize("index", range(len(SHELVES)))
def test_its_parts_import_one_way(index):
    above = {f"tensegym.flexure.{name}" for name in SHELVES[index + 1 :]}
    assert not [name for name in loaded(SHELVES[index]) if name.startswith(tuple(above))]


def test_the_public_names_are_there():
    from tensegym import flexure
    from tensegym.flexure import fem, hinge, measured, models

    for package in (flexure, fem, hinge, measured, models):
        assert all(hasattr(package, name) for name in package.__all__), package
