"""What the documents point at is there: files, folders, modules, links."""

import re
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
FOLDERS = {path.name for path in ROOT.iterdir() if path.is_dir()} | {p.name for p in (ROOT / "tensegym").iterdir()}


def named(text):
    """Whatever stands in backticks and looks like a path of this repository or a module of the package."""
    for name in re.findall(r"`([\w./*-]+)(?:::\w+)?`", text):
        path = "/" in name and name.split("/")[0] in FOLDERS
        environment = re.search(r"-v\d+$", name)
        if (path and not environment) or re.fullmatch(r"tensegym(\.\w+)+", name):
            yield name


def is_there(name, page):
    if "/" in name:
        return any(list(base.glob(name)) for base in (ROOT, ROOT / "tensegym", page.parent))
    module, _, attribute = name.rpartition(".")
    try:
        return hasattr(import_module(module), attribute) or find_spec(name) is not None
    except ModuleNotFoundError:
        return False


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_files_and_modules_that_are_named_are_there(page):
    assert [name for name in named(page.read_text()) if not is_there(name, page)] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_to_files(page):
    links = [link.split("#")[0] for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text()) if "://" not in link]
    assert [link for link in links if link and not (page.parent / link).exists()] == []


def test_every_page_is_reached_from_the_readme():
    readme = PAGES[0].read_text()
    assert [page.name for page in PAGES[1:] if page.name not in readme] == []
