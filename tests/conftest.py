"""Shared pieces. One thread a process, set before anything imports a BLAS."""

import os
import signal

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as in the background of a shell; children inherit it
    signal.signal(signal.SIGINT, signal.default_int_handler)

import pytest

from tensegym.cli.main import run


@pytest.fixture
def cli(capsys):
    """Run a command line in this process: (status, stdout, stderr)."""

    def call(*argv: object) -> tuple[int, str, str]:
        capsys.readouterr()
        try:
            status = run([str(a) for a in argv])
        except SystemExit as stop:
            status = int(stop.code or 0)
        out, err = capsys.readouterr()
        return status, out, err

    return call


def assert_refused(result, *words):
    """One clear line on stderr that names ``words``, nothing on stdout, a non-zero exit."""
    status, out, err = result
    lines = [line for line in err.strip().splitlines() if line]
    assert status == 2
    assert out == ""
    assert len(lines) == 1, lines
    for word in words:
        assert word in lines[0]
