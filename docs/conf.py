"""Sphinx: `make docs` builds the pages of this folder, and those that docs/generate.py makes, into build/docs.

Nothing is fetched: no other project's index, no fonts, no scripts from elsewhere; docs/check.py holds pages to it.
"""

import os
import re
import sys
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

import tensegym  # noqa: E402
from docs.generate import write_pages  # noqa: E402

project, author, release = "tensegym", "the tensegym authors", tensegym.__version__
html_title = f"tensegym {release}"
copyright = author
extensions = ["myst_parser", "sphinx_gallery.gen_gallery"]
html_theme = "furo"
html_baseurl = ""
html_show_sphinx = False
exclude_patterns = ["**/README.md", "examples/*"]
suppress_warnings = ["config.cache"]
myst_enable_extensions = ["fieldlist", "colon_fence", "attrs_inline"]
myst_heading_anchors = 4
python_use_unqualified_type_names = True
toc_object_entries = False
add_module_names = False
sphinx_gallery_conf = {
    "examples_dirs": "examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"plot_",
    "within_subsection_order": "FileNameSortKey",
    "download_all_examples": False,
    "show_signature": False,
    "remove_config_comments": True,
    "show_memory": False,
    "write_computation_times": False,
    "abort_on_example_error": True,
    "reset_modules": (),
    "min_reported_time": 1e9,
    "copyfile_regex": "",
}

_PAGES = {"index": "README.md", "project/contributing": "CONTRIBUTING.md", "project/changelog": "CHANGELOG.md"}


def _from_the_top(app, name, source):
    """Put a page of the repository's top before the page that stands for it here, its links turned to this folder."""
    if name not in _PAGES:
        return
    up = "../" * name.count("/")
    text = (ROOT / _PAGES[name]).read_text()
    text = re.sub(r"(\]\(|src=\")docs/", rf"\g<1>{up}", text)
    for page, top in _PAGES.items():
        text = text.replace(f"]({top})", f"]({up}{page}.md)")
    source[0] = f"{text}\n{source[0]}"


def setup(app):
    app.connect("builder-inited", lambda app: write_pages(Path(app.srcdir) / "reference"))
    app.connect("source-read", _from_the_top)
