"""Page: a viser server that listens where it is told to and nowhere else."""

from __future__ import annotations

import contextlib
import errno
import io
import logging
import socket
from typing import Any

import numpy as np
import viser
from numpy.typing import ArrayLike, NDArray

from tensegym.errors import InputError

LOOPBACK = "127.0.0.1"


class Page(viser.ViserServer):
    """A page at ``http://host:port``.

    It asks no other machine for anything: viser's sharing, which opens a tunnel over a server of its makers, is off.

    Args:
        title: at the top of its panel.
        host: address to listen on.
        port: to listen on; 0 for any that is free.

    Raises:
        InputError: the port is in use, or this machine has no such address.
    """

    def __init__(self, title: str, host: str = LOOPBACK, port: int = 8080) -> None:
        _check_free(host, port)
        with contextlib.redirect_stdout(io.StringIO()):
            super().__init__(host=host, port=port, label=title, verbose=False)
        if port and self.get_port() != port:  # taken in between
            self.stop()
            raise InputError(_taken(port))
        self.gui.configure_theme(show_logo=False, show_share_button=False, control_width="medium")
        for name in ("websockets.server", "websockets.asyncio.server"):  # would tell of what is no browser's request
            logging.getLogger(name).setLevel(logging.CRITICAL)
        self.url = f"http://{host}:{self.get_port()}"

    def request_share_url(self, verbose: bool = True) -> str | None:
        """None: nothing leaves this machine."""
        return None

    def stop(self) -> None:
        """Close all connections and stop listening."""
        with contextlib.redirect_stdout(io.StringIO()):
            super().stop()

    def __enter__(self) -> Page:
        return self

    def __exit__(self, *_: Any) -> None:
        self.stop()


def linear(colours: ArrayLike) -> NDArray[np.uint8]:
    """Colours (..., 3), 0 to 255, for batches of meshes and for arrows: viser takes those as linear light, all others
    as sRGB (IEC 61966-2-1)."""
    share = np.asarray(colours) / 255
    return np.round(255 * np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)).astype(np.uint8)


def _check_free(host: str, port: int) -> None:
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind, protocol) as tried:
            tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # as the server does after an earlier one
            tried.bind(address)
    except socket.gaierror:
        raise InputError(_strange(host)) from None
    except PermissionError:
        raise InputError(f"port = {port} is not for everyone; take one from 1024 on, or --port 0 for any") from None
    except OSError as error:
        if error.errno == errno.EADDRNOTAVAIL:
            raise InputError(_strange(host)) from None
        raise InputError(_taken(port)) from None


def _strange(host: str) -> str:
    return f"host = {host!r} is no address of this machine; {LOOPBACK} is this machine alone"


def _taken(port: int) -> str:
    return f"port = {port} is in use, by another viewer perhaps; give another one, or --port 0 for any that is free"
