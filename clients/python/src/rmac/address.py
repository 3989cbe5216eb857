"""Where an appliance listens: `host:port`, or `unix:` and the path of a socket."""

from __future__ import annotations

import pathlib
import re
import socket
import stat
from dataclasses import dataclass

from rmac.errors import CannotConnect

DEFAULT_PORT = 7402
_HOST_PORT = re.compile(r"(?:\[(?P<v6>[^\]]+)\]|(?P<host>[^:\[\]]+))(?::(?P<port>\d+))?")


@dataclass(frozen=True, slots=True)
class Address:
    host: str = ""
    port: int = DEFAULT_PORT
    path: str = ""  # of a UNIX socket; empty: TCP

    def __str__(self) -> str:
        return f"unix:{self.path}" if self.path else f"{self.host}:{self.port}"

    def connect(self, within_s: float) -> socket.socket:
        """A connected socket, or `CannotConnect` with what to do about it."""
        if self.path:
            self.check_socket()
        try:
            if not self.path:
                connected = socket.create_connection((self.host, self.port), timeout=within_s)
                tune(connected)
            else:
                connected = socket.socket(socket.AF_UNIX)
                connected.settimeout(within_s)
                connected.connect(self.path)
        except UnicodeError:
            raise self.no_name() from None
        except OSError as error:
            raise self.unreachable(error) from error
        connected.settimeout(None)
        return connected

    def check_socket(self) -> None:
        """A path that is none of a socket's is a mistake with a name, rather than an errno."""
        try:
            mode = pathlib.Path(self.path).stat().st_mode
        except FileNotFoundError:
            raise CannotConnect(f"{self}: there is no such file; is rmacd running, and is its state_folder another one?") from None
        except OSError as error:
            raise self.unreachable(error) from error
        if not stat.S_ISSOCK(mode):
            raise CannotConnect(f"{self}: this is a file, and no socket")

    def no_name(self) -> CannotConnect:
        return CannotConnect(f"{self}: this is no name of a host")

    def unreachable(self, error: OSError) -> CannotConnect:
        hint = "; is rmacd running there?" if isinstance(error, ConnectionRefusedError) else ""
        return CannotConnect(f"{self}: {error.strerror or error}{hint}")


def tune(connected: socket.socket) -> None:
    """Of TCP: nothing waits for more, and a peer that is silently gone is noticed within 20 s."""
    connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    connected.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in (("TCP_KEEPIDLE", 5), ("TCP_KEEPINTVL", 5), ("TCP_KEEPCNT", 3), ("TCP_USER_TIMEOUT", 20_000)):
        if hasattr(socket, name):  # not on every system
            connected.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)


def parse_address(text: str) -> Address:
    if not isinstance(text, str):
        raise CannotConnect(f"{text!r} is no address: give it as text, as \"host:{DEFAULT_PORT}\" or \"unix:/path\"")
    if text.startswith("unix:"):
        path = text.removeprefix("unix:")
        if not path:
            raise CannotConnect('"unix:" needs the path of a socket behind it, as unix:/run/rmac/rmacd.sock')
        return Address(path=path)
    match = _HOST_PORT.fullmatch(text)
    if match is None:
        raise CannotConnect(f'"{text}" is no address: give host:{DEFAULT_PORT}, [v6 address]:{DEFAULT_PORT} or unix:/path')
    port = int(match["port"] or DEFAULT_PORT)
    if not 0 < port < 65536:
        raise CannotConnect(f'"{text}": a port is 1 to 65535')
    return Address(host=match["v6"] or match["host"], port=port)
