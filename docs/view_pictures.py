"""Takes the pictures of docs/view.md in a real browser: docs/pictures/view-*.png.

Run in the repository's root: python -m docs.view_pictures [NAME ...]. Needs Chromium, and the extras view and dev.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tensegym.flexure.hinge import preset
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.replay.retake import retake
from tensegym.tasks.policy_trials import FIRST_SEED, policy_setup
from tensegym.view.choice import Choice
from tensegym.view.hinge_view import HingeView
from tensegym.view.live import Live
from tensegym.view.page import Page
from tensegym.view.player import Player
from tests.browser import Tab, chromium

FOLDER = Path(__file__).parent / "pictures"
SIZE = {"width": 1280, "height": 760}


@contextmanager
def running(view: Any) -> Iterator[Any]:
    threading.Thread(target=view.run, daemon=True).start()
    yield view
    view.end()


def _save(browser: Any, view: Any, name: str, act: Callable[[Tab], None]) -> None:
    tab = Tab(browser, view.page.url)
    tab.page.set_viewport_size(SIZE)
    tab.page.wait_for_selector("canvas")
    for close in tab.page.get_by_role("alert").get_by_role("button").all():  # says that there is no GPU
        close.click()
    act(tab)
    tab.page.wait_for_timeout(3000)
    tab.page.screenshot(path=str(FOLDER / f"view-{name}.png"))
    tab.close()
    print(f"docs/pictures/view-{name}.png", *tab.complaints, *tab.abroad)


def rolling(browser: Any) -> None:
    """A policy rolls to a place that was clicked."""
    with Page("tensegym", port=0) as page, running(Live(page, Choice("rolling"))) as live:

        def act(tab: Tab) -> None:
            tab.page.get_by_text("updates/s").wait_for()
            tab.page.wait_for_timeout(4000)
            tab.page.mouse.click(560, 560)
            tab.page.wait_for_timeout(5000)
            tab.page.get_by_role("button", name="pause").click()

        _save(browser, live, "rolling", act)


def climbing(browser: Any) -> None:
    """On a slope, with node numbers."""
    with Page("tensegym", port=0) as page, running(Live(page, Choice("climb"))) as live:

        def act(tab: Tab) -> None:
            tab.page.get_by_text("updates/s").wait_for()
            tab.page.get_by_label("node numbers").check()
            tab.page.wait_for_timeout(5000)
            tab.page.get_by_role("button", name="pause").click()

        _save(browser, live, "climbing", act)


def replay(browser: Any) -> None:
    """A payload is carried, played from a recording."""
    recording = retake(policy_setup("carry", seconds=8.0), FIRST_SEED, "carry")
    with Page("tensegym", port=0) as page, running(Player(page, [recording])) as player:

        def act(tab: Tab) -> None:
            tab.page.wait_for_timeout(6000)
            tab.page.get_by_role("button", name="pause").click()

        _save(browser, player, "replay", act)


def hinge(browser: Any) -> None:
    """The paper's hinge, bent, by all models."""
    bent = preset("trls2")
    with Page("tensegym flexure", port=0) as page, running(HingeView(page, bent, fit_joint(bent, held_out=0))) as view:

        def act(tab: Tab) -> None:
            view.sliders[2].value = 0.6 * view.sliders[2].max
            view.sliders[1].value = 0.5 * view.sliders[1].max

        _save(browser, view, "hinge", act)


PICTURES = {make.__name__: make for make in (rolling, climbing, replay, hinge)}

if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    with chromium() as browser:
        for name in sys.argv[1:] or PICTURES:
            PICTURES[name](browser)
