"""Who can reach a page, and what it tells them."""

import socket

import pytest

pytest.importorskip("viser", reason="no viser here: pip install '.[view]'")
from tensegym.errors import InputError
from tensegym.view.page import LOOPBACK, Page
from tests.conftest import assert_refused


@pytest.fixture(scope="module")
def page():
    with Page("tensegym", port=0) as served:
        yield served


def get(page, path):
    """Status and text of a path, asked for as it stands."""
    with socket.create_connection((LOOPBACK, page.get_port()), timeout=10) as asked:
        asked.sendall(f"GET {path} HTTP/1.1\r\nHost: {LOOPBACK}\r\nConnection: close\r\n\r\n".encode())
        answer = b"".join(iter(lambda: asked.recv(65536), b""))
    return int(answer.split()[1]), answer


def test_it_serves_its_page_and_nothing_outside_its_folder(page):
    assert get(page, "/")[0] == 200
    for path in ("/../__init__.py", "/..%2f__init__.py", "/%2e%2e/%2e%2e/_viser.py", "//etc/passwd", "/etc/passwd",
                 "/..\\__init__.py"):  # fmt: skip
        status, answer = get(page, path)
        assert status == 404, path
        assert b"import" not in answer


def test_it_listens_on_loopback_alone(page):
    with open("/proc/net/tcp") as table:
        listening = [row.split()[1] for row in table.readlines()[1:] if row.split()[3] == "0A"]
    addresses = [at.split(":")[0] for at in listening if int(at.split(":")[1], 16) == page.get_port()]
    assert addresses == ["0100007F"]  # 127.0.0.1


def test_nothing_is_shared_over_another_machine(page):
    assert page.request_share_url() is None


def test_a_port_that_is_taken_is_named(page, cli):
    with pytest.raises(InputError, match=f"port = {page.get_port()} is in use"):
        Page("another", port=page.get_port())
    assert_refused(cli("view", "--port", page.get_port()), "in use", "--port 0")


def test_an_address_of_another_machine_is_refused():
    with pytest.raises(InputError, match="no address of this machine"):
        Page("tensegym", host="192.0.2.1", port=0)


@pytest.mark.parametrize(("options", "words"), [
    (["--policy", "runner"], ["runner", "rolling"]),
    (["--design", "nowhere.toml"], ["nowhere.toml"]),
    (["--task", "fly"], ["fly", "roll"]),
    (["--engine", "ode"], ["ode", "pybullet"]),
    (["--start", "1-2-3"], ["1-2-3"]),
    (["--port", "70000"], ["70000", "65535"]),
    (["--study", "search/study.db"], ["search/study.db is a file", "give search"]),
    (["--study", "note.html"], ["note.html is a file", "design run --out"]),
    (["--study", "empty"], ["no search in empty"]),
    (["--replay", "search"], ["search is a folder", "a file"]),
    (["--replay", "note.html"], ["note.html", "no recording"]),
    (["--replay", "cut.html"], ["cut.html", "cut off"]),
    (["--design", "note.html"], ["note.html", ".toml"]),
])  # fmt: skip
def test_what_cannot_be_shown_is_refused_in_one_line(cli, tmp_path, monkeypatch, options, words):
    monkeypatch.chdir(tmp_path)
    for folder in ("search", "empty"):
        (tmp_path / folder).mkdir()
    for file in ("search/storage.txt", "search/study.db", "note.html"):
        (tmp_path / file).write_text("no page")
    (tmp_path / "cut.html").write_text('<script id="recording" type="text/plain">eNqrVkrKTy')
    assert_refused(cli("view", *options), *words)


def test_without_viser_the_extra_is_named(cli, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "viser", None)
    for module in [name for name in sys.modules if name.startswith("tensegym.view")]:
        monkeypatch.delitem(sys.modules, module)
    assert_refused(cli("view"), "viser is not installed", "extra view")
