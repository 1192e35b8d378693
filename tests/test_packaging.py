"""The package as pyproject.toml, the links and the imports make it."""

import re
import subprocess
import sys
import tomllib
from importlib.metadata import distributions, version
from pathlib import Path

import pytest

import tensegym

ROOT = Path(__file__).parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
LINKED = ("envs", "train", "urdf")


def python(code, cwd=None):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=cwd)


def test_packages_are_the_folders_with_an_init():
    found = {"tensegym"}
    for top in ("tensegym", *LINKED):
        for init in (ROOT / top).rglob("__init__.py"):
            parts = init.parent.relative_to(ROOT).parts
            if parts[0] == "tensegym" and len(parts) > 1 and parts[1] in LINKED:
                continue  # through a link
            found.add(".".join(parts if parts[0] == "tensegym" else ("tensegym", *parts)))
    assert sorted(PROJECT["tool"]["setuptools"]["packages"]) == sorted(found)


def test_no_module_lies_in_a_folder_without_an_init():
    bare = {
        path.parent
        for top in ("tensegym", *LINKED)
        for path in (ROOT / top).rglob("*.py")
        if not (path.parent / "__init__.py").is_file()
    }
    assert bare == set()


@pytest.mark.parametrize("name", LINKED)
def test_links_are_relative_and_lead_where_the_package_dir_says(name):
    link = ROOT / "tensegym" / name
    assert link.is_symlink()
    assert str(link.readlink()) == f"../{name}"
    assert link.resolve() == ROOT / name
    assert PROJECT["tool"]["setuptools"]["package-dir"][f"tensegym.{name}"] == name


def test_every_data_file_is_packaged():
    """Whatever git keeps under the package's folders is Python, or matched by package-data."""
    listed = subprocess.run(["git", "ls-files", "tensegym", *LINKED], capture_output=True, text=True, cwd=ROOT)
    if listed.returncode:
        pytest.skip("not a git checkout")
    data = PROJECT["tool"]["setuptools"]["package-data"]
    missing = []
    for name in listed.stdout.splitlines():
        path = ROOT / name
        if path.suffix == ".py" or path.is_symlink() or not path.exists():
            continue
        parts = Path(name).parts if name.startswith("tensegym/") else ("tensegym", *Path(name).parts)
        packages = [(".".join(parts[:n]), Path(*parts[n:])) for n in range(1, len(parts))]
        if not any(relative.full_match(p) if hasattr(relative, "full_match") else relative.match(p)
                   for package, relative in packages for p in data.get(package, [])):  # fmt: skip
            missing.append(name)
    assert missing == []


@pytest.mark.parametrize("name", ["envs", "train"])
def test_the_bare_folder_refuses_to_be_imported(name):
    done = python(f"import {name}", cwd=ROOT)
    assert done.returncode == 1
    assert f"import tensegym.{name}, not {name}" in done.stderr


def test_every_pybullet_call_names_its_client():
    source = "\n".join(path.read_text() for path in (ROOT / "tensegym" / "bullet").glob("*.py"))
    calls = re.findall(r"pybullet\.([a-z]\w*)\(((?:[^()]|\([^()]*(?:\([^()]*\)[^()]*)*\))*)\)", source)
    assert len(calls) > 30
    nameless = [name for name, arguments in calls if "client" not in arguments and name not in ("connect",)]
    assert nameless == []


def test_the_package_runs_as_a_module_from_anywhere(tmp_path):
    done = subprocess.run([sys.executable, "-m", "tensegym", "--version"], capture_output=True, text=True, cwd=tmp_path)
    assert (done.returncode, done.stdout.strip()) == (0, tensegym.__version__)


def test_no_hint_names_an_index_that_has_no_such_package():
    """The package is installed from its sources: `pip install tensegym` finds nothing, or another one."""
    hint = re.compile(r"pip install '?tensegym")
    paths = [p for top in ("tensegym", *LINKED, "benchmarks") for p in (ROOT / top).rglob("*.py")]
    assert [p for p in [*paths, *ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")] if hint.search(p.read_text())] == []


@pytest.mark.parametrize("command", ["simulate", "validate", "step"])
def test_commands_without_learning_load_none(command):
    from tensegym.cli.main import COMMANDS

    module = COMMANDS[command][0].split(":")[0]
    code = f"import sys, {module}; print([m for m in ('torch', 'stable_baselines3', 'matplotlib') if m in sys.modules])"
    assert python(code).stdout.splitlines() == ["[]"]


def test_version_is_pyprojects():
    assert tensegym.__version__ == version("tensegym") == PROJECT["project"]["version"]


def _name(requirement):
    return re.match(r"[\w.-]+", requirement).group().lower().replace("_", "-").replace(".", "-")


def _pins():
    lines = [line.split("#")[0].strip() for line in (ROOT / "constraints.txt").read_text().splitlines()]
    return dict(re.fullmatch(r"([\w.-]+)==([\w.+-]+)", line).groups() for line in lines if line)


def test_constraints_pin_every_requirement():
    pins = {_name(name): number for name, number in _pins().items()}
    project = PROJECT["project"]
    wanted = [*project["dependencies"], *(r for extra in project["optional-dependencies"].values() for r in extra)]
    assert {_name(r) for r in wanted} - set(pins) == set()
    from packaging.requirements import Requirement

    for requirement in map(Requirement, wanted):
        assert requirement.specifier.contains(pins[_name(requirement.name)]), requirement


def test_what_runs_here_is_what_the_constraints_pin():
    installed = {_name(d.metadata["Name"]): d.version.split("+")[0] for d in distributions()}
    pins = {_name(name): number for name, number in _pins().items()}
    off = {name: (installed[name], pins[name]) for name in installed.keys() & pins if installed[name] != pins[name]}
    assert off == {}
    assert len(installed.keys() & pins) > 30


def test_files_name_no_place_on_a_machine():
    """The URDFs, configs and policies that ship are the same wherever they were written."""
    for top in LINKED:
        for path in (ROOT / top).rglob("*"):
            if path.suffix in (".urdf", ".yaml", ".json"):
                text = path.read_text()
                assert str(ROOT) not in text, path
                assert not re.search(r"/(home|tmp|Users)/", text), path
