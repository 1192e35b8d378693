"""Imports run one way, module by module and shelf by shelf; only one shelf touches the engine; modules stay small."""

import ast
import graphlib
import subprocess
import sys
from pathlib import Path
from statistics import median, quantiles

import pytest

ROOT = Path(__file__).parents[1]
SHELVES = (  # each may import from itself and from those before it
    "errors", "arrays", "files", "compiled", "tables", "report", "plotting", "progress", "processes", "flexure",
    "structure", "structures", "design", "exchange", "physics", "engine", "bullet", "mujoco", "robot", "flexible",
    "control", "tasks", "envs", "urdf", "replay", "train", "search", "compare", "validation", "view", "tensegym",
    "cli",
    "__main__",
)  # fmt: skip
ENGINES = {"pybullet": "bullet", "pybullet_data": "bullet", "mujoco": "mujoco"}  # and the one shelf that imports each
MEMORY = ("ctypes", "llvmlite.binding")  # C interfaces, and what engines hold
LINKED = ("envs", "train", "urdf")


def _modules():
    """Path of every module of the package, by its name."""
    found = {}
    for top in ("tensegym", *LINKED):
        for path in (ROOT / top).rglob("*.py"):
            parts = path.relative_to(ROOT).with_suffix("").parts
            if parts[0] == "tensegym" and len(parts) > 1 and parts[1] in LINKED:
                continue  # through a link
            parts = parts if parts[0] == "tensegym" else ("tensegym", *parts)
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


MODULES = _modules()


def shelf(module):
    return module.split(".")[1] if "." in module else "tensegym"


def imports_of(module):
    """Modules and packages that a module imports, at its top, in its functions and for type checkers."""
    package = module if MODULES[module].name == "__init__.py" else module.rpartition(".")[0]
    for node in ast.walk(ast.parse(MODULES[module].read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            parents = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            source = ".".join([*parents, *([node.module] if node.module else [])])
            for alias in node.names:
                yield f"{source}.{alias.name}" if f"{source}.{alias.name}" in MODULES else source


IMPORTS = {module: set(imports_of(module)) for module in MODULES}
OWN = {module: {name for name in names if name in MODULES} - {module} for module, names in IMPORTS.items()}


def test_every_module_stands_on_a_shelf():
    assert {shelf(module) for module in MODULES} - set(SHELVES) == set()


def test_every_import_of_the_package_is_of_a_module_that_is_there():
    wanted = {name for names in IMPORTS.values() for name in names if name.split(".")[0] in ("tensegym", *LINKED)}
    assert wanted - set(MODULES) == set()


def test_imports_run_down():
    """At the top of modules, in functions and for type checkers alike."""
    height = {name: n for n, name in enumerate(SHELVES)}
    up = [f"{module} imports {name}" for module, names in OWN.items() for name in names
          if height[shelf(name)] > height[shelf(module)]]  # fmt: skip
    assert up == []


def test_no_modules_import_one_another_in_a_circle():
    list(graphlib.TopologicalSorter(OWN).static_order())


LOADED = """
import sys
from importlib import import_module
for shelf in {shelves}:
    for module in shelf:
        import_module(module)
    print(*sorted(sys.modules))
"""


def test_what_a_shelf_loads_is_below_it():
    """Import shelf after shelf in one process: no module of a later one, and no engine before the engine's shelf."""
    shelves = [sorted(name for name in MODULES if shelf(name) == s) for s in SHELVES if s != "__main__"]
    code = LOADED.format(shelves=shelves)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    steps = dict(zip(SHELVES, done.stdout.strip().splitlines(), strict=False))
    assert len(steps) == len(shelves)
    allowed = {"tensegym", "envs"}  # importing any of the package registers its environments
    for name, loaded in steps.items():
        allowed.add(name)
        names = set(loaded.split())
        assert {shelf(module) for module in names if module.split(".")[0] == "tensegym"} <= allowed, name
        assert all((library in names) <= (home in allowed) for library, home in ENGINES.items()), name
        assert not names & {"torch", "stable_baselines3"} or "train" in allowed, name
        assert "matplotlib" not in names or "train" in allowed, name  # which Stable-Baselines3 brings


def test_importing_the_package_brings_nothing_heavy():
    heavy = {"torch", "stable_baselines3", "matplotlib", "scipy", "numba", "tqdm", "yaml", "tyro", *ENGINES}
    code = "import sys, tensegym; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert heavy & set(done.stdout.split()) == set()


def using(library):
    """Shelves that import a library, or a part of it."""
    return {shelf(m) for m, names in IMPORTS.items() if any(f"{n}.".startswith(f"{library}.") for n in names)}


def test_only_an_engines_shelf_touches_it_and_its_memory():
    assert all(using(library) <= {home} for library, home in ENGINES.items())
    assert set().union(*map(using, MEMORY)) <= set(ENGINES.values())


HOMES = {
    "matplotlib": {"plotting"}, "optuna": {"search"}, "ray": {"search"}, "torch": {"control", "train"},
    "tqdm": {"progress"}, "tyro": {"cli", "train"}, "viser": {"view"},
}  # fmt: skip


@pytest.mark.parametrize("library", HOMES)
def test_heavy_libraries_have_one_home(library):
    assert using(library) == HOMES[library]


def test_modules_are_small():
    lines = {module: len(path.read_text().splitlines()) for module, path in MODULES.items()}
    assert median(lines.values()) <= 120
    assert quantiles(lines.values(), n=10)[-1] <= 220
    assert {module for module, count in lines.items() if count > 300} == set()
