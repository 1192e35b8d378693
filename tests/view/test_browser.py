"""The pages in a real browser: what its user does reaches the simulation, and nothing leaves the machine."""

import threading
import time
from queue import Queue

import numpy as np
import pytest

from tests.browser import PATIENCE, Tab, chromium

pytest.importorskip("viser", reason="no viser here: pip install '.[view]'")
from tensegym.view.choice import Choice
from tensegym.view.live import Live
from tensegym.view.page import Page


@pytest.fixture(scope="module")
def browser():
    with chromium() as opened:
        yield opened


@pytest.fixture(scope="module")
def live(browser):
    with Page("tensegym", port=0) as page:
        shown = Live(page, Choice("rolling"))
        threading.Thread(target=shown.run, daemon=True).start()
        yield shown
        shown.end()


@pytest.fixture(scope="module")
def tab(browser, live):
    opened = Tab(browser, live.page.url)
    opened.page.get_by_text("updates/s").wait_for()
    yield opened
    opened.close()
    assert opened.complaints == []
    assert opened.abroad == []


def frame_when(live, holds):
    """The first frame of the simulation of which a condition holds."""
    end = time.monotonic() + PATIENCE / 1000
    while time.monotonic() < end:
        answer = Queue()
        live.requests.put(lambda served, answer=answer: answer.put(served.tell("frame")))
        frame = answer.get(timeout=PATIENCE / 1000)
        if holds(frame):
            return frame
        time.sleep(0.05)
    raise AssertionError("it never held")


def pick(tab, label, option):
    tab.page.get_by_role("combobox", name=label).click()
    tab.page.get_by_role("option", name=option, exact=True).click()


def test_a_policy_plays_and_a_click_on_the_ground_is_where_it_goes(live, tab):
    first = frame_when(live, lambda frame: frame.commands.max() > 0)
    assert not np.isfinite(first.place).any()
    tab.page.mouse.click(450, 480)  # on the ground in front, between the panels
    placed = frame_when(live, lambda frame: np.isfinite(frame.place).all())
    assert np.linalg.norm(placed.place - first.poses[:, :2].mean(axis=0)) < 5
    later = frame_when(live, lambda frame: frame.time > placed.time + 0.5)
    assert np.allclose(later.place, placed.place, atol=1e-6)  # a place, though the robot moves


def test_a_slider_turns_a_drive_and_another_viewer_sees_it(browser, live, tab):
    pick(tab, "driven by", "sliders")
    frame_when(live, lambda frame: frame.time < 2 and not frame.commands.any())
    other = Tab(browser, live.page.url)
    tab.page.get_by_role("slider").first.focus()
    tab.page.keyboard.press("End")
    turned = frame_when(live, lambda frame: frame.angles[0] > 1)
    assert turned.commands[0] == pytest.approx(live.controls.sliders[0].max)
    assert not turned.commands[1:].any()
    value = float(other.page.get_by_role("slider").first.get_attribute("aria-valuenow"))
    assert value == pytest.approx(turned.commands[0], rel=1e-3)
    other.close()
    assert other.complaints == other.abroad == []


def test_time_stops_goes_on_by_steps_and_begins_anew(live, tab):
    tab.page.get_by_role("button", name="pause").click()
    tab.page.get_by_role("button", name="play").wait_for()
    before = frame_when(live, lambda _: True).time
    assert frame_when(live, lambda _: True).time == before
    tab.page.get_by_role("button", name="step").click()
    after = frame_when(live, lambda frame: frame.time > before).time
    assert after == pytest.approx(before + 0.1)  # a slider's command is held so long
    tab.page.get_by_role("button", name="restart").click()
    frame_when(live, lambda frame: frame.time < before)
