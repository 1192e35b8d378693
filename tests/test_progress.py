"""A bar for who looks at it, and a log file without one."""

import io
import sys

import pytest

from tensegym.progress import progress_bar


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.mark.parametrize(("stream", "shown"), [(Terminal, True), (io.StringIO, False)])
def test_a_bar_is_drawn_on_a_terminal_alone(monkeypatch, stream, shown):
    monkeypatch.setattr(sys, "stderr", stream())
    with progress_bar(total=3, unit="pull") as bar:
        for _ in range(3):
            bar.update()
        bar.set_postfix_str("done")
    assert ("3/3" in sys.stderr.getvalue()) == shown
    assert bool(sys.stderr.getvalue()) == shown
