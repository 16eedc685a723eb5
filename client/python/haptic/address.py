"""Where a daemon is: a Unix socket's path, or host and port. As hapticctl finds it.

    what is given                          "/path", "name", "host:port", "[::1]:port"
    HAPTICD_SERVER                         if it is set: host:port
    HAPTICD_SOCKET                         if it is set
    /run/hapticd/hapticd.sock              of the system service, if there is one
    $XDG_RUNTIME_DIR/hapticd/hapticd.sock  of an ordinary user's daemon
    /tmp/hapticd-UID/hapticd.sock          where there is no XDG_RUNTIME_DIR
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from haptic.errors import Invalid

SERVICE_SOCKET = "/run/hapticd/hapticd.sock"


@dataclass(frozen=True)
class Address:
    """`path` of a Unix socket; if it is empty, `host` and `port` of TCP."""

    path: str = ""
    host: str = ""
    port: str = ""

    def __str__(self) -> str:
        if self.path:
            return self.path
        return f"[{self.host}]:{self.port}" if ":" in self.host else f"{self.host}:{self.port}"


@dataclass(frozen=True)
class Identity:
    """PEM files for TLS, as `hapticctl certificates` makes them. All empty: no TLS."""

    certificate: str = ""
    key: str = ""
    authority: str = ""  # who must have signed the daemon's certificate

    def __bool__(self) -> bool:
        return bool(self.certificate or self.key or self.authority)


def parse_address(text: str) -> Address:
    """What has a slash or no colon is a path; the rest is host:port, with an IPv6 address in brackets."""
    host, colon, port = text.rpartition(":")
    if not colon or "/" in text:
        return Address(path=text)
    if len(host) >= 2 and host.startswith("[") and host.endswith("]"):
        host = host[1:-1]
    return Address(host=host, port=port)


def find_address(given: str | os.PathLike[str] = "") -> Address:
    """`given`, or where hapticctl would look. Raises Invalid if HAPTICD_SERVER is no host:port."""
    if text := os.fspath(given):
        return parse_address(text)
    if server := os.environ.get("HAPTICD_SERVER"):
        address = parse_address(server)
        if address.path:
            raise Invalid(f'"{server}" is no server; host:port is expected')
        return address
    if socket := os.environ.get("HAPTICD_SOCKET"):
        return Address(path=socket)
    if Path(SERVICE_SOCKET).exists():
        return Address(path=SERVICE_SOCKET)
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    folder = f"{runtime}/hapticd" if runtime else f"/tmp/hapticd-{os.getuid()}"
    return Address(path=f"{folder}/hapticd.sock")


def find_identity() -> Identity:
    """HAPTICD_CERTIFICATE, HAPTICD_KEY and HAPTICD_AUTHORITY."""
    return Identity(*(os.environ.get("HAPTICD_" + name, "") for name in ("CERTIFICATE", "KEY", "AUTHORITY")))
