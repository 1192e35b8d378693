"""The pages in a real browser: what its user does reaches the simulation, and nothing leaves the machine."""

import threading
import time
from queue import Queue

import numpy as np
import pytest

from tests.browser import PATIENCE, Tab, chromium

pytest.importorskip("viser", reason="no viser here: pip install '.[view]'")
from tensegym.flexure.hinge import preset
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.replay import read_replay
from tensegym.view.choice import Choice
from tensegym.view.hinge_view import FEM, HingeView
from tensegym.view.live import Live
from tensegym.view.page import Page
from tensegym.view.player import Player
from tensegym.view.session import PERIOD

HINGE = preset("leaf-spring")


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


def test_what_is_recorded_is_downloaded_and_opens_as_a_replay(browser, live, tab, tmp_path):
    tab.page.get_by_role("button", name="record", exact=True).click()
    end = tab.page.get_by_role("button", name="end and download")
    end.wait_for()
    begun = live.frame.time
    frame_when(live, lambda frame: frame.time > begun + 1)
    with tab.page.expect_download() as download:
        end.click()
    path = tmp_path / download.value.suggested_filename
    download.value.save_as(path)
    kept = read_replay(path)
    assert kept.seconds > 1
    assert np.diff(kept.times) == pytest.approx(PERIOD, abs=0.3 * PERIOD)
    tab.page.get_by_role("button", name="record", exact=True).wait_for()  # again
    replay = Tab(browser, path.as_uri())
    replay.page.wait_for_selector("body[data-ready]")
    assert "rolling" in replay.page.inner_text("#title")
    replay.close()
    assert replay.complaints == replay.abroad == []


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


@pytest.fixture
def opened(browser):
    """Opens what is to run in a page of its own, and a browser on it."""
    closed = []

    def open_view(make):
        page = Page("tensegym", port=0)
        view = make(page)
        threading.Thread(target=view.run, daemon=True).start()
        tab = Tab(browser, page.url)
        closed.append((page, view, tab))
        tab.page.get_by_role("slider").first.wait_for()
        return view, tab

    yield open_view
    for page, view, tab in closed:
        tab.close()
        view.end()
        page.stop()
        assert tab.complaints == tab.abroad == []


def until(holds):
    end = time.monotonic() + PATIENCE / 1000
    while not holds():
        assert time.monotonic() < end, "it never held"
        time.sleep(0.05)


def test_a_replay_plays_and_scrubs(opened, recording):
    player, tab = opened(lambda page: Player(page, [recording, recording], ["one", "two"]))
    until(lambda: player.time > 0)
    tab.page.get_by_role("slider").first.focus()
    tab.page.keyboard.press("End")
    until(lambda: player.time == player.slider.max)
    assert not player.playing
    tab.page.keyboard.press("Home")
    until(lambda: player.time == 0)


def test_a_hinge_bends_under_its_sliders(opened):
    joint = fit_joint(HINGE, held_out=0)
    view, tab = opened(lambda page: HingeView(page, HINGE, joint))
    assert view.answers[FEM].theta == pytest.approx(0, abs=1e-12)
    tab.page.get_by_role("slider").nth(2).focus()
    tab.page.keyboard.press("End")
    until(lambda: view.answers[FEM].theta > 0.9 * joint.box.max_angle)
    tab.page.get_by_text("error [deg]").wait_for()
