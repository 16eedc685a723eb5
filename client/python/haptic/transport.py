"""A connected stream, over a Unix socket, TCP, or TLS 1.3 over TCP; and in words why there is none."""

from __future__ import annotations

import asyncio
import errno
import os
import socket
import ssl

from haptic.address import Address, Identity
from haptic.errors import Invalid, Unreachable

Streams = tuple[asyncio.StreamReader, asyncio.StreamWriter]

_SHUTDOWN = 1.0  # s
_QUEUE = 0.01  # s, between two looks whether there is room in it

_ADVICE = {
    errno.ENOENT: "there is no socket; is hapticd running?",
    errno.ECONNREFUSED: "nobody listens there; is hapticd running?",
    errno.EACCES: "permission denied; are you in a group that hapticd's config allows?",
}


def reason_of(error: OSError) -> str:
    """Why a socket failed, in words that tell what to do."""
    if isinstance(error, ssl.SSLCertVerificationError):
        return f"it cannot be trusted: {error.verify_message}"
    if isinstance(error, ssl.SSLError):
        return (error.reason or str(error)).lower().replace("_", " ")
    return _ADVICE.get(error.errno or 0) or error.strerror or str(error)


def tls_context(identity: Identity) -> ssl.SSLContext:
    """Shows the program's certificate, and believes no server but one that the authority signed for its name.

    Raises Invalid if a file is missing or cannot be used.
    """
    for what, file in (("certificate", identity.certificate), ("key", identity.key), ("authority", identity.authority)):
        if not file:
            raise Invalid(f"TLS needs a certificate, its key and an authority; the {what} is missing")
        if not os.access(file, os.R_OK):
            raise Invalid(f"cannot read {file}, the {what}")
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.minimum_version = ssl.TLSVersion.TLSv1_3
    try:
        context.load_verify_locations(identity.authority)
    except ssl.SSLError as error:
        raise Invalid(f"cannot use {identity.authority} as the authority: {reason_of(error)}") from error
    try:
        context.load_cert_chain(identity.certificate, identity.key)
    except ssl.SSLError as error:
        raise Invalid(
            f"cannot use {identity.certificate} with the key {identity.key}: {reason_of(error)}"
        ) from error
    return context


async def _open_unix(path: str) -> Streams:
    """Waits while the daemon has more to let in than fits into its queue, which asyncio takes for a connection."""
    stream = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        stream.setblocking(False)
        while True:
            try:
                stream.connect(path)
                break
            except BlockingIOError:
                await asyncio.sleep(_QUEUE)
        return await asyncio.open_unix_connection(sock=stream)
    except BaseException:
        stream.close()
        raise


async def open_streams(address: Address, identity: Identity) -> Streams:
    """Raises Unreachable, or Invalid for files of TLS that cannot be used."""
    try:
        if address.path:
            return await _open_unix(address.path)
        tls = tls_context(identity) if identity else None
        reader, writer = await asyncio.open_connection(
            address.host, address.port, ssl=tls, ssl_shutdown_timeout=_SHUTDOWN if tls else None)
        writer.get_extra_info("socket").setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return reader, writer
    except OSError as error:
        raise Unreachable(f"cannot reach the daemon at {address}: {reason_of(error)}") from error
