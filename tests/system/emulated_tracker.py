"""A Polhemus FASTRAK at the other end of a serial line, which is a socket here: its station 1, and records of it for as
long as it is asked to send."""

import select
import socket
import struct
import threading

PERIOD = 1.0 / 120  # s, of a record with one station on
ALONE = b"cSCfu"  # commands of one letter; others end with CR, and are passed over


class EmulatedTracker:
    def __init__(self, line):
        self.line = line
        # a serial line keeps nothing for a reader that comes later
        line.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 0)
        self.place = (0.0, 0.0, 0.0)  # cm
        self.sends = False
        self.command = b""
        self.thread = threading.Thread(target=self._serve, daemon=True)
        self.thread.start()

    def _serve(self):
        try:
            while True:
                if select.select([self.line], [], [], PERIOD)[0]:
                    letters = self.line.recv(4096)
                    if not letters:
                        return
                    for letter in letters:
                        self._take(bytes([letter]))
                elif self.sends:
                    # full where nobody reads: what does not fit is lost, as on any serial line
                    if select.select([], [self.line], [], 0)[1]:
                        self.line.sendall(b"01 " + struct.pack("<7f", *self.place, 1.0, 0.0, 0.0, 0.0) + b" ")
        except OSError:
            return  # the machine is gone

    def _take(self, letter):
        is_alone = not self.command and letter in ALONE
        self.command += letter
        if is_alone:
            self._obey(letter)
        if is_alone or letter == b"\r":
            self.command = b""

    def _obey(self, letter):
        if letter in b"cC":
            self.sends = letter == b"C"
        if letter == b"S":
            self.line.sendall(b"21S" + b"0" * 50 + b"\r\n")
