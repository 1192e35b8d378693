"""Compiled code is kept for as long as no kernel's source changes, and done without where it cannot be kept."""

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import tensegym
from tensegym import compiled

LAW = '''
from tensegym.compiled import kernel

@kernel(inline="always")
def law(x):
    return {factor} * x
'''
USER = '''
from tensegym.compiled import kernel
from tensegym.law import law

@kernel
def force(x):
    return law(x) + 1.0
'''
ASK = '''
from tensegym.user import force
print(force(2.0), sum(force.stats.cache_hits.values()))
'''


class Tree:
    """A package of two modules with kernels, and what its force is in a process of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.package = folder, folder / "tensegym"
        self.package.mkdir()
        (self.package / "__init__.py").write_text("")
        shutil.copy(compiled.__file__, self.package)
        (self.package / "user.py").write_text(USER)
        self.home = folder / "home"
        self.home.mkdir()
        self.change(3.0)

    def change(self, factor: float) -> None:
        """Change a law and leave the module that uses it."""
        (self.package / "law.py").write_text(LAW.format(factor=factor))

    def ask(self, code: str = ASK, **environment: str) -> tuple[float, int, str]:
        """The force at 2, how often kept code was used, and what was said."""
        inherited = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
        own = {"PYTHONPATH": str(self.folder), "HOME": str(self.home), "XDG_CACHE_HOME": str(self.home)}
        done = subprocess.run([sys.executable, "-c", code], env=inherited | own | environment, text=True,
                              capture_output=True, check=True, cwd=self.folder)  # fmt: skip
        force, hits = done.stdout.split()
        return float(force), int(hits), done.stderr

    def kept(self) -> list[Path]:
        return [path for path in self.folder.rglob("kernels-*") if path.is_dir()]


@pytest.fixture
def tree(tmp_path):
    return Tree(tmp_path)


def test_a_change_in_an_inlined_module_is_seen_and_what_has_not_changed_is_kept(tree):
    assert tree.ask() == (7.0, 0, "")
    assert tree.ask() == (7.0, 1, "")
    tree.change(4.0)
    assert tree.ask() == (9.0, 0, "")
    assert tree.ask() == (9.0, 1, "")
    (only,) = tree.kept()
    assert only.parent == tree.package / "__pycache__"


def test_other_versions_do_not_share(tree):
    tree.ask()
    other = "import numpy; numpy.__version__ = '2.4.0'" + ASK
    assert tree.ask(other) == (7.0, 0, "")


def test_beside_a_package_that_cannot_be_written_the_users_cache_is_taken(tree):
    (tree.package / "__pycache__").write_text("a file, as root writes anywhere")
    assert tree.ask() == (7.0, 0, "")
    assert tree.ask() == (7.0, 1, "")
    (only,) = tree.kept()
    assert only.parent == tree.home / "tensegym"


def test_where_nothing_can_be_written_it_goes_on_and_says_so_once(tree):
    (tree.package / "__pycache__").write_text("")
    tree.home.rmdir()
    tree.home.write_text("")
    force, hits, said = tree.ask()
    assert (force, hits) == (7.0, 0)
    assert said.count("compiled kernels are not kept") == said.count("\n") == 1
    assert "NUMBA_CACHE_DIR names another folder" in said
    assert tree.kept() == []


def test_numbas_own_setting_comes_first(tree):
    assert tree.ask(NUMBA_CACHE_DIR=str(tree.folder / "mine"))[0] == 7.0
    (only,) = tree.kept()
    assert only.parent == tree.folder / "mine"


def test_kept_files_that_were_cut_short_are_made_again(tree):
    tree.ask()
    for pattern in ("*.nbi", "*.nbc"):
        (kept,) = (path for path in tree.kept()[0].rglob(pattern) if "force" in path.name)
        kept.write_bytes(kept.read_bytes()[: 5 if pattern == "*.nbi" else 50])
        assert tree.ask() == (7.0, 0, "")
        assert tree.ask() == (7.0, 1, "")


def test_a_full_disk_stops_nothing(tree):
    full = """
import tensegym.compiled

def full(*_):
    raise OSError(28, "No space left on device")

tensegym.compiled.FunctionCache.save_overload = full
"""
    force, _, said = tree.ask(full + ASK)
    assert force == 7.0
    assert said.count("not kept") == 1


def modules():
    root = Path(tensegym.__file__).parent
    return {path: path.read_text() for path in root.rglob("*.py") if path.name != "compiled.py"}


def test_every_kernel_is_made_here_and_takes_its_numbers_from_modules_that_are_counted():
    root = Path(tensegym.__file__).parent
    counted = {"tensegym." + ".".join(path.relative_to(root).with_suffix("").parts)
               for path, source in modules().items() if compiled._MARK.decode() in source}  # fmt: skip
    for path, source in modules().items():
        assert "njit" not in source, f"{path}: take tensegym.compiled.kernel"
        if compiled._MARK.decode() not in source:
            continue
        tree, own = ast.parse(source), ("tensegym", *path.relative_to(root).parent.parts)
        brought = {}
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (node.level or (node.module or "").startswith("tensegym")):
                base = ".".join(own[: len(own) - node.level + 1]) if node.level else ""
                module = ".".join(part for part in (base, node.module) if part)
                brought |= {alias.asname or alias.name: module for alias in node.names}
        for function in ast.walk(tree):
            if not (isinstance(function, ast.FunctionDef) and "kernel" in map(_name, function.decorator_list)):
                continue
            body = (node for statement in function.body for node in ast.walk(statement))
            used = {node.id for node in body if isinstance(node, ast.Name)}
            for name in used & brought.keys():
                options = {brought[name], f"{brought[name]}.{name}"}
                assert options & counted, f"{path}: {function.name} takes {name} from {brought[name]}, without kernels"


def _name(decorator: ast.expr) -> str:
    called = decorator.func if isinstance(decorator, ast.Call) else decorator
    return called.id if isinstance(called, ast.Name) else ""
