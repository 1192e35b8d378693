"""docs/check.py: built pages whose links lead nowhere, or that load from elsewhere, are found."""

import pytest

from docs.check import faults

GOOD = '<h1 id="top">A</h1><a href="b.html#there">b</a><a href="https://example.org">out</a><img src="p.png">'


@pytest.fixture
def site(tmp_path):
    (tmp_path / "a.html").write_text(GOOD)
    (tmp_path / "b.html").write_text('<p id="there"><a href="a.html">a</a></p>')
    (tmp_path / "p.png").write_bytes(b"")
    return tmp_path


def test_a_sound_site_has_no_fault(site):
    assert list(faults(site)) == []


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("b.html#there", "c.html", "c.html leads nowhere"),
        ("#there", "#here", "b.html#here has no such place"),
        ('src="p.png"', 'src="https://example.org/p.png"', "loads https://example.org/p.png"),
        ("<h1", '<script src="//example.org/x.js"></script><h1', "loads //example.org/x.js"),
        ("<h1", '<link rel="stylesheet" href="https://example.org/x.css"><h1', "loads https://example.org/x.css"),
    ],
)
def test_each_kind_of_fault_is_told(site, old, new, fault):
    (site / "a.html").write_text(GOOD.replace(old, new, 1))
    (found,) = faults(site)
    assert found.endswith(fault)


def test_a_style_that_fetches_a_font_is_told(site):
    (site / "x.css").write_text("@font-face { src: url('https://example.org/f.woff2') }")
    (found,) = faults(site)
    assert found.endswith("loads https://example.org/f.woff2")
