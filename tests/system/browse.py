"""Looks at the page of haptic-view as a browser does: what it shows, and whether a WebSocket of it reaches the daemon.

usage: browse.py ADDRESS PORT
"""

import base64
import json
import os
import re
import socket
import sys
import urllib.request

BINARY = b"\x82"  # how a whole binary message begins, RFC 6455 section 5.2; what ends a WebSocket begins otherwise


def fetch(where, path):
    with urllib.request.urlopen(f"http://{where}{path}", timeout=10) as answer:
        return answer.headers.get_content_type(), answer.read()


def first_message(address, port):
    """What the WebSocket of the page says first; beside the upgrade that is the daemon's hello."""
    with socket.create_connection((address, port), timeout=10) as stream:
        key = base64.b64encode(os.urandom(16)).decode()
        stream.sendall((f"GET /ws HTTP/1.1\r\nHost: {address}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                        f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n"
                        "Sec-WebSocket-Protocol: haptic.v1\r\n\r\n").encode())
        received = b""
        while b"\r\n\r\n" not in received or not received.split(b"\r\n\r\n", 1)[1]:
            more = stream.recv(65536)
            if not more:
                break
            received += more
        head, _, message = received.partition(b"\r\n\r\n")
        return head.split(b"\r\n")[0].decode(), message


def main():
    address, port = sys.argv[1], int(sys.argv[2])
    where = f"{address}:{port}"
    kind, page = fetch(where, "/")
    script = re.search(rb'src="\.?(/assets/[^"]+\.js)"', page)
    script_kind = fetch(where, script.group(1).decode())[0] if script else None
    status, message = first_message(address, port)
    print(json.dumps({"page": kind, "script": script_kind, "upgrade": status, "hello": message[:1] == BINARY}))


if __name__ == "__main__":
    main()
