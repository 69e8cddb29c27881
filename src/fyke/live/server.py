"""The server of the live page: on this machine only unless asked otherwise, one page for each browser."""

from __future__ import annotations

import errno
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, redirect_stdout
from functools import partial
from io import StringIO
from pathlib import Path

import viser
import websockets.asyncio.server
from websockets.typing import Origin

from .page import Page
from .study import Study

LOCAL = ("127.0.0.1", "localhost")
PORTS_TRIED = 100
_NO_HOST = (errno.EADDRNOTAVAIL, socket.EAI_NONAME, socket.EAI_FAIL)


class AddressError(ValueError):
    """A host that was not allowed or is none of this machine, or no free port; in words for the reader."""

    def __init__(self, found: str, allowed: str, cure: str) -> None:
        self.found, self.allowed, self.cure = found, allowed, cure
        super().__init__(f"{found}; allowed: {allowed}; {cure}")


class _LocalServer(viser.ViserServer):
    """The server without viser's tunnel to the internet, which any browser could otherwise ask for."""

    def request_share_url(self, verbose: bool = True) -> str | None:
        """Refuse."""
        return None


@contextmanager
def _own_pages_only(port: int) -> Iterator[None]:
    """Make a server that starts within accept its socket from its own pages only.

    A page of any other site, open in the same browser, could otherwise connect to it, see the net and move it. viser
    has no setting for this, but what it is built on has.
    """
    module, allowed = websockets.asyncio.server, [Origin(f"http://{name}:{port}") for name in LOCAL]
    whole = module.serve
    # None: programs other than browsers, which send no origin.
    # A class there, and a partial does as well: types cannot say so.
    module.serve = partial(whole, origins=[*allowed, None])  # type: ignore[assignment,misc]
    try:
        yield
    finally:
        module.serve = whole  # type: ignore[misc] # as above


class Live:
    """A running server; pages: one for each browser by its number."""

    def __init__(self, server: viser.ViserServer, host: str, port: int) -> None:
        self.server, self.host, self.port = server, host, port
        self.pages: dict[int, Page] = {}

    @property
    def url(self) -> str:
        """Address to open in a browser."""
        return f"http://{self.host}:{self.port}"

    def stop(self) -> None:
        """End all pages and the server."""
        for page in list(self.pages.values()):
            page.close()
        with redirect_stdout(StringIO()):
            self.server.stop()


def serve(
    text: str,
    path: Path,
    *,
    host: str = LOCAL[0],
    port: int = 8080,
    open_to_network: bool = False,
) -> Live:
    """Serve a case; the next free port is taken when the wanted one is in use.

    host: other than this machine itself only with open_to_network. Raises CaseError and live.study.RefusedError for
    a case that cannot be shown, AddressError for a host that is not allowed and when no port is free.
    """
    if host not in LOCAL and not open_to_network:
        raise AddressError(
            f"the host {host}, by which other machines may get in",
            f"{LOCAL[0]}, this machine only",
            "leave --host out, or add --open-to-network if that is wanted",
        )
    Study(text, path)  # A case that makes no page is told here, and the kernels are compiled.
    free = free_port(host, port)
    with redirect_stdout(StringIO()), _own_pages_only(free) if host in LOCAL else nullcontext():
        server = _LocalServer(host=host, port=free, label="fyke", verbose=False)
    live = Live(server, host, free)
    cases = sorted(path.resolve().parent.glob("*.toml"))
    lock = threading.Lock()

    @server.on_client_connect
    def _(client: viser.ClientHandle) -> None:
        page = Page(client, text, path.resolve(), cases)
        with lock:
            live.pages[client.client_id] = page

    @server.on_client_disconnect
    def _(client: viser.ClientHandle) -> None:
        with lock:
            page = live.pages.pop(client.client_id, None)
        if page is not None:
            page.close()

    return live


def free_port(host: str, wanted: int) -> int:
    """Return the wanted port of a host or the next free one; AddressError when there is none."""
    for port in range(wanted, min(wanted + PORTS_TRIED, 65536)):
        with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind((host, port))
            except PermissionError:
                continue
            except OSError as error:
                if error.errno in _NO_HOST:
                    raise AddressError(
                        f"the host {host}", "an address of this machine", "leave --host out"
                    ) from None
                continue
            return port
    raise AddressError(f"no free port from {wanted} on", "a free port", "name another one with --port")
