#!/usr/bin/python3
"""A 3Dconnexion SpaceMouse on the machine that it runs on, by the kernel's uhid, which a test pushes by lines on
standard input:

    plug
    unplug
    push X Y Z    how far, in counts of 350; told again and again until it is 0 0 0, as a puck does
    report

Each is answered with one line of JSON, or "error". The end of the input unplugs it.
"""

import json
import os
import select
import struct
import sys
import time

# linux/uhid.h
DESTROY, OUTPUT = 1, 6
GET_REPORT, GET_REPORT_REPLY, SET_REPORT, SET_REPORT_REPLY = 9, 10, 13, 14
CREATE2, INPUT2 = 11, 12
DATA = 4096
EVENT = 4 + 4372  # bytes: the type, and the largest of its unions
EIO = 5
BUS_USB = 3
VENDOR, PRODUCT = 0x256F, 0xC635  # SpaceMouse Compact

PERIOD = 0.016  # s, between reports
MOTION, BUTTONS, LED = 1, 3, 4  # ids of reports


def axes(first):
    """Three axes of 16 bits, from -350 to 350: usages from `first` on."""
    return bytes([0x09, first, 0x09, first + 1, 0x09, first + 2, 0x16, 0xA2, 0xFE, 0x26, 0x5E, 0x01, 0x75, 16, 0x95, 3,
                  0x81, 0x06])


# generic desktop, multi-axis controller: motion, buttons, and a LED to be told
DESCRIPTOR = (bytes([0x05, 1, 0x09, 8, 0xA1, 1])
              + bytes([0x85, MOTION, 0x05, 1]) + axes(0x30) + axes(0x33)
              + bytes([0x85, BUTTONS, 0x05, 9, 0x19, 1, 0x29, 2, 0x15, 0, 0x25, 1, 0x75, 1, 0x95, 16, 0x81, 2])
              + bytes([0x85, LED, 0x05, 8, 0x09, 0x4B, 0x15, 0, 0x25, 1, 0x75, 1, 0x95, 8, 0x91, 2])
              + bytes([0xC0]))


class Spacemouse:
    def __init__(self):
        self.node = None
        self.pushed = (0, 0, 0)
        self.is_lit = False

    def plug(self):
        if self.node is None:
            self.node = os.open("/dev/uhid", os.O_RDWR)
            self.write(CREATE2, struct.pack("=128s64s64sHHIIII4096s", b"Emulated SpaceMouse", b"tests", b"MOUSE01",
                                            len(DESCRIPTOR), BUS_USB, VENDOR, PRODUCT, 0, 0, DESCRIPTOR))

    def unplug(self):
        if self.node is not None:
            self.write(DESTROY, b"")
            os.close(self.node)
        self.node, self.is_lit = None, False

    def push(self, *counts):
        self.pushed = tuple(map(int, counts))
        if len(self.pushed) != 3:
            raise ValueError("push needs three counts")
        self.tell_motion()

    def tell_motion(self):
        if self.node is not None:
            report = struct.pack("<B6h", MOTION, *self.pushed, 0, 0, 0)
            self.write(INPUT2, struct.pack(f"=H{DATA}s", len(report), report))

    def write(self, kind, body):
        os.write(self.node, struct.pack("=I", kind) + body)

    def take_event(self):
        event = os.read(self.node, EVENT)
        kind = struct.unpack_from("=I", event)[0]
        if kind == OUTPUT:
            size = struct.unpack_from("=H", event, 4 + DATA)[0]
            report = event[4:4 + size]
            if size >= 2 and report[0] == LED:
                self.is_lit = report[1] != 0
        elif kind in (GET_REPORT, SET_REPORT):  # it has no features
            number = struct.unpack_from("=I", event, 4)[0]
            reply = GET_REPORT_REPLY if kind == GET_REPORT else SET_REPORT_REPLY
            self.write(reply, struct.pack("=IH", number, EIO))

    def obey(self, verb, *words):
        if verb not in ("plug", "unplug", "push", "report"):
            raise ValueError(f"there is no verb {verb}")
        if verb != "report":
            getattr(self, verb)(*words)
        return json.dumps({"plugged": self.node is not None, "lit": self.is_lit})


def main():
    mouse = Spacemouse()
    due = time.monotonic()
    while True:
        wanted = [sys.stdin.fileno()] + ([mouse.node] if mouse.node is not None else [])
        ready = select.select(wanted, [], [], max(0.0, due - time.monotonic()))[0]
        if mouse.node in ready:
            mouse.take_event()
        if sys.stdin.fileno() in ready:
            line = sys.stdin.readline()
            if not line:
                break
            try:
                print(mouse.obey(*line.split()), flush=True)
            except (OSError, ValueError, TypeError) as error:
                print(f"error: {error}", flush=True)
        if time.monotonic() >= due:
            due = time.monotonic() + PERIOD
            if any(mouse.pushed):
                mouse.tell_motion()
    mouse.unplug()


if __name__ == "__main__":
    main()
