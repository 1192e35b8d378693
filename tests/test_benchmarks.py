"""Benchmarks take minutes and are not run by the tests: here each name that one imports is looked for."""

import ast
import sys
from importlib import import_module
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[1] / "benchmarks"


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.py")), ids=lambda path: path.stem)
def test_what_a_benchmark_imports_is_there(path, monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == "tensegym":
            module = import_module(node.module)
            for alias in node.names:
                there = hasattr(module, alias.name) or f"{node.module}.{alias.name}" in sys.modules
                assert there or import_module(f"{node.module}.{alias.name}"), alias.name
