"""What is shown of a recording at a time."""

import pytest

pytest.importorskip("viser", reason="no viser here: pip install '.[view]'")
from tensegym.replay import write_replay
from tensegym.view.player import frame_at
from tests.conftest import assert_refused


def test_the_frame_of_a_time_is_the_last_row_until_then(recording):
    start = recording.times[0]
    for seconds, row in ((-1.0, 0), (0.0, 0), (0.0499, 0), (0.05, 1), (0.52, 10), (99.0, 19)):
        frame = frame_at(recording, seconds)
        assert frame.time == recording.times[row] == pytest.approx(start + 0.05 * row)
        assert (frame.poses == recording.poses[row]).all()
        assert (frame.tensions == recording.tensions[row]).all()


def test_a_replay_goes_with_no_option_of_a_robot_that_runs(cli, recording, tmp_path):
    path = tmp_path / "run.html"
    write_replay(recording, path)
    assert_refused(cli("view", "--replay", path, "--policy", "rolling"), "--policy", "no effect")
    assert_refused(cli("view", "--replay", path, "--study", tmp_path), "--replay", "--study")
    assert_refused(cli("view", "--replay", tmp_path / "none.html"), "none.html")
    path.write_text("<html></html>")
    assert_refused(cli("view", "--replay", path), "no recording")
    assert_refused(cli("view", "--study", tmp_path), "no search")
