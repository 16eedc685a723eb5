"""Looks at the page of haptic-view as a browser does: what it shows, and whom the daemon takes it for.

usage: browse.py ADDRESS PORT [TOKEN]
"""

import base64
import json
import os
import re
import socket
import sys
import urllib.request

from haptic import v1

# RFC 6455 section 5.2: a whole binary message, what ends a WebSocket begins otherwise; its length is in two more bytes
BINARY, LONGER = 0x82, 126


def fetch(where, path):
    with urllib.request.urlopen(f"http://{where}{path}", timeout=10) as answer:
        return answer.headers.get_content_type(), answer.read()


def receive(stream, size):
    data = b""
    while len(data) < size:
        more = stream.recv(size - len(data))
        if not more:
            raise ConnectionError(f"it ended after {data!r}")
        data += more
    return data


def first_message(address, port, token):
    """What the WebSocket of the page answers, and says first."""
    with socket.create_connection((address, port), timeout=10) as stream:
        key = base64.b64encode(os.urandom(16)).decode()
        query = f"?token={token}" if token else ""
        stream.sendall((f"GET /ws{query} HTTP/1.1\r\nHost: {address}:{port}\r\nUpgrade: websocket\r\n"
                        f"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n"
                        "Sec-WebSocket-Protocol: haptic.v1\r\n\r\n").encode())
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += receive(stream, 1)
        kind, size = receive(stream, 2)
        if size == LONGER:
            size = int.from_bytes(receive(stream, 2), "big")
        return head.split(b"\r\n")[0].decode(), receive(stream, size) if kind == BINARY else None


def main():
    address, port = sys.argv[1], int(sys.argv[2])
    where = f"{address}:{port}"
    kind, page = fetch(where, "/")
    script = re.search(rb'src="\.?(/assets/[^"]+\.js)"', page)
    script_kind = fetch(where, script.group(1).decode())[0] if script else None
    status, message = first_message(address, port, sys.argv[3] if len(sys.argv) > 3 else None)
    role = None if message is None else v1.Role.Name(v1.Envelope.FromString(message).hello.role)
    print(json.dumps({"page": kind, "script": script_kind, "upgrade": status, "role": role}))


if __name__ == "__main__":
    main()
