"""A replay's page in a real browser: opened from disk it shows what was recorded, and asks nobody for anything."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tensegym.design.design import flexible_design
from tensegym.physics.box import Box
from tensegym.physics.terrain import FLAT
from tensegym.replay import Recorder, write_replay
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.surface import on_top
from tests.browser import Tab, chromium

AHEAD = Box.between((0.6, -1.0, -0.1), (1.2, 1.0, 0.08))
RAMP = Box((-1.5, 0.2, 0.0), (0.6, 0.4, 0.1), tuple(Rotation.from_euler("zy", [30, -15], degrees=True).as_quat()))


@pytest.fixture(scope="module")
def recording():
    recorder = Recorder("a < b & c </script>")
    with TensegrityRobot(flexible_design(), dt=2e-3, ground=FLAT.holding([AHEAD, RAMP])) as robot:
        robot.command(0.4 * robot.command_limit)
        for _ in range(51):
            recorder.look(robot, face=0)
            robot.step(10)
    return recorder.recording()


@pytest.fixture(scope="module")
def tab(recording, tmp_path_factory):
    file = tmp_path_factory.mktemp("replay") / "run.html"
    write_replay(recording, file)
    with chromium() as browser:
        opened = Tab(browser, file.as_uri())
        requests = []
        opened.page.on("request", lambda request: requests.append(request.url))
        opened.page.reload()
        opened.page.wait_for_selector("body[data-ready]")
        yield opened
        assert {url.partition("#")[0] for url in requests} == {file.as_uri()}
        assert opened.complaints == []
        assert opened.abroad == []


def clock(tab):
    return float(tab.page.inner_text("#clock").split()[2])


def pictures(tab):
    return tab.page.evaluate("[...document.querySelectorAll('canvas')].map((c) => c.toDataURL())")


def scrub(tab, time):
    tab.page.locator("#time").evaluate("(s, t) => { s.value = t; s.dispatchEvent(new Event('input')); }", time)


def test_it_says_what_it_shows(tab, recording):
    assert tab.page.title() == recording.title == tab.page.inner_text("#title")
    assert "six_rod_flexible" in tab.page.inner_text("#about")
    assert tab.page.locator("#plots canvas").count() == 5


def test_the_slider_goes_to_another_time(tab):
    scrub(tab, 0.0)
    before = pictures(tab)
    scrub(tab, 0.63)
    assert clock(tab) == pytest.approx(0.63, abs=0.006)
    changed = [a != b for a, b in zip(before, pictures(tab), strict=True)]
    assert changed[0] and all(changed[2:])  # the view and every plot; the colours' key stays


def test_the_robot_stands_where_it_stood(tab, recording):
    """At recorded times as recorded, and between two of them halfway along."""
    nodes = "replay.robot.scenery.nodes.bodies.map((_, n) => replay.robot.node(n))"
    for row in (0, 17, 50):
        scrub(tab, recording.times[row])
        assert np.array(tab.page.evaluate(nodes)) == pytest.approx(recording.nodes[row], abs=1e-5)
    tab.page.evaluate("t => replay.seek(t)", recording.times[20:22].mean())
    assert np.array(tab.page.evaluate(nodes)) == pytest.approx(recording.nodes[20:22].mean(axis=0), abs=1e-5)
    assert np.array(tab.page.evaluate("replay.robot.centre()")) == pytest.approx(
        recording.centres[20:22].mean(axis=0), abs=1e-6
    )


def test_what_lies_on_the_ground_lies_on_boxes_too(tab, recording):
    points = np.random.default_rng(5).uniform([-2.2, -0.5], [1.5, 0.8], (80, 2))
    tops = np.array(tab.page.evaluate("ps => ps.map(([x, y]) => replay.view.onTop(x, y))", points.tolist()))
    wanted = on_top(recording.ground, points)
    assert len(np.unique(wanted[:, 2].round(3))) > 8  # ground, box and ramp are all met
    assert tops - [0, 0, 0.002] == pytest.approx(wanted, abs=1e-6)


def test_it_plays_to_its_end_in_slow_motion_too(tab):
    tab.page.select_option("#speed", "0.5")
    scrub(tab, 0.9)
    tab.page.click("#play")
    assert tab.page.inner_text("#play") == "Pause"
    tab.page.get_by_role("button", name="Play").wait_for()
    assert clock(tab) == 1.0


def test_a_step_is_a_row_and_a_plot_is_a_slider(tab, recording):
    scrub(tab, 0.5)
    tab.page.click("#on")
    assert clock(tab) == pytest.approx(recording.times[26], abs=0.006)
    tab.page.click("#back")
    assert clock(tab) == pytest.approx(recording.times[25], abs=0.006)
    tab.page.locator("#plots canvas").nth(1).click(position={"x": 60, "y": 40})
    assert clock(tab) < 0.1


def test_a_link_names_a_time(tab):
    tab.page.evaluate("location.hash = 't=0.3'; location.reload()")
    tab.page.wait_for_selector("body[data-ready]")
    assert clock(tab) == pytest.approx(0.3, abs=0.006)


def test_dragging_turns_the_view(tab):
    turn = tab.page.evaluate("replay.view.turn")
    box = tab.page.locator("#view").bounding_box()
    tab.page.mouse.move(box["x"] + 200, box["y"] + 200)
    tab.page.mouse.down()
    tab.page.mouse.move(box["x"] + 260, box["y"] + 200)
    tab.page.mouse.up()
    assert tab.page.evaluate("replay.view.turn") == pytest.approx(turn - 0.4)
