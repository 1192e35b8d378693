"""What the documents point at is there: files, folders, modules, links."""

import re
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
OWN = ("", "tutorials", "project")  # folders of docs whose pages are written by hand
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md",
         *sorted(page for folder in OWN for page in (ROOT / "docs" / folder).glob("*.md"))]  # fmt: skip
WRITTEN = {"runs", "build", "dist", "demo"}  # by commands
FOLDERS = {path.name for base in (ROOT, ROOT / "tensegym") for path in base.iterdir() if path.is_dir()} - WRITTEN


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
    made = ("gallery/", "reference/", "README.md", "index.md")  # by `make docs`, which looks at all links
    links = [link.split("#")[0] for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text()) if "://" not in link]
    links = [link for link in links if link and not link.removeprefix("../").startswith(made)]
    assert [link for link in links if not (page.parent / link).exists()] == []


def test_every_page_is_reached_from_the_readme_and_from_the_index():
    readme, index = PAGES[0].read_text(), (ROOT / "docs" / "index.md").read_text()
    top = [page for page in PAGES[1:] if page.parent.name in ("docs", ROOT.name) and page.name != "index.md"]
    assert [page.name for page in top if page.name not in readme] == []
    under = [page.relative_to(ROOT / "docs").with_suffix("") for page in PAGES[2:] if page.name != "index.md"]
    assert [str(page) for page in under if f"{page}\n" not in index] == []
