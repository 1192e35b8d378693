"""Files whole or absent, and one command a folder."""

import json
import os
import subprocess
import sys

import pytest

from tensegym.errors import InputError
from tensegym.files import is_empty, lock_folder, replace_file, replace_path, write_json, write_text


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_file_takes_its_place_when_it_is_whole(tmp_path):
    path = tmp_path / "text.csv"
    write_text(path, "one\n")
    with pytest.raises(ZeroDivisionError), replace_file(path) as file:
        file.write("tw")
        file.flush()
        assert path.read_text() == "one\n"
        raise ZeroDivisionError
    assert path.read_text() == "one\n"
    assert names(tmp_path) == ["text.csv"]


def test_a_folder_takes_the_place_of_another_when_it_is_whole(tmp_path):
    path = tmp_path / "best"
    for text in ("one", "two"):
        with replace_path(path) as fresh:
            (fresh / "urdf").mkdir(parents=True)
            (fresh / "urdf" / text).write_text(text)
    assert names(path / "urdf") == ["two"]
    with pytest.raises(ZeroDivisionError), replace_path(path) as fresh:
        fresh.mkdir()
        raise ZeroDivisionError
    assert names(path / "urdf") == ["two"] and names(tmp_path) == ["best"]


def test_the_fresh_name_ends_as_the_wanted_one(tmp_path):
    with replace_path(tmp_path / "roll.mp4") as fresh:
        assert fresh.suffix == ".mp4"
        fresh.write_bytes(b"film")
    assert names(tmp_path) == ["roll.mp4"]


def test_on_a_full_disk_the_old_file_stays(tmp_path, monkeypatch):
    path = tmp_path / "state.json"
    write_json(path, {"steps": 1})

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OSError, match="No space left"):
        write_json(path, {"steps": 2})
    assert json.loads(path.read_text()) == {"version": 1, "steps": 1} and names(tmp_path) == ["state.json"]


def test_links_stay_links_and_devices_devices(tmp_path):
    real, link = tmp_path / "real.txt", tmp_path / "link.txt"
    write_text(real, "one")
    link.symlink_to(real)
    write_text(link, "two")
    assert link.is_symlink() and real.read_text() == "two"
    null = tmp_path / "null"
    null.symlink_to(os.devnull)
    write_text(null, "gone")
    assert os.path.exists(os.devnull) and not os.path.isfile(os.devnull)


HOLD = """
import sys, time
from pathlib import Path
from tensegym.files import lock_folder
with lock_folder(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(600)
"""


@pytest.fixture
def holder(tmp_path):
    """A process that holds the folder ``run``."""
    process = subprocess.Popen([sys.executable, "-c", HOLD, str(tmp_path / "run")], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "held\n"
    yield process
    process.kill()
    process.wait()


def test_a_folder_in_use_is_refused_with_the_name_of_who_uses_it(tmp_path, holder):
    with pytest.raises(InputError, match=rf"run is in use by `.*`, process {holder.pid} on .*, since \d+-"):
        lock_folder(tmp_path / "run").__enter__()


def test_a_killed_command_holds_nothing_and_leaves_nothing_half_written(tmp_path, holder):
    run = tmp_path / "run"
    (run / "best").mkdir()
    (run / "best" / ".tensegym-123-x.csv").write_text("hal")
    (run / ".tensegym-old-checkpoint").mkdir()  # the moment between the old and the new folder
    (run / ".tensegym-old-checkpoint" / "weights").write_text("whole")
    (run / ".tensegym-old-best").mkdir()
    holder.kill()
    holder.wait()
    with lock_folder(run):
        pass
    assert names(run) == ["best", "checkpoint"] and names(run / "best") == []
    assert names(run / "checkpoint") == ["weights"]


def test_a_start_that_fails_leaves_no_folder(tmp_path):
    folder = tmp_path / "runs" / "one"
    with pytest.raises(ZeroDivisionError), lock_folder(folder):
        assert is_empty(folder)
        raise ZeroDivisionError
    assert names(tmp_path) == []
    with lock_folder(folder):
        write_text(folder / "kept", "")
    assert names(folder) == ["kept"] and not is_empty(folder)
    with lock_folder(folder):
        pass
    assert names(folder) == ["kept"]


def test_a_file_in_the_folders_place_is_refused(tmp_path):
    (tmp_path / "run").write_text("mine")
    with pytest.raises(InputError, match="run is a file"):
        lock_folder(tmp_path / "run").__enter__()
