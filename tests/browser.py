"""A real browser for tests: Debian's Chromium without a window, whose every request and complaint is kept."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from urllib.parse import urlsplit

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
SOFTWARE = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox")  # WebGL without a GPU
PATIENCE = 180_000  # ms; a machine with other work on it draws in software for long


@contextmanager
def chromium() -> Iterator:
    """A browser; the test is skipped where there is none."""
    if CHROMIUM is None:
        pytest.skip("no Chromium here: apt install chromium")
    playwright = pytest.importorskip("playwright.sync_api", reason="no playwright here: pip install '.[dev]'")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=[*SOFTWARE])
        try:
            yield browser.new_context(viewport={"width": 900, "height": 560})
        finally:
            browser.close()


class Tab:
    """A page that is open; ``complaints`` are its errors, ``abroad`` what it asked of other machines, which is refused.

    page: playwright's.
    """

    def __init__(self, browser, url):
        self.page = browser.new_page()
        self.page.set_default_timeout(PATIENCE)
        self.complaints, self.abroad = [], []
        self.page.on("console", lambda told: self.complaints.append(told.text) if told.type == "error" else None)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.route("**/*", self._let)
        self.page.goto(url)

    def _let(self, route):
        parts = urlsplit(route.request.url)
        if parts.scheme in ("file", "data", "blob") or parts.hostname in ("127.0.0.1", "localhost"):
            route.continue_()
        else:
            self.abroad.append(route.request.url)
            route.abort()

    def close(self):
        self.page.close()
