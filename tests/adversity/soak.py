"""hapticd for a long time, on a machine that is used roughly: what it misses, and whether anything heaps up.

    soak.py HAPTICD HAPTICCTL CONFIG --seconds 3600     serves, a share of the time in each kind of trouble
    soak.py HAPTICD HAPTICCTL CONFIG --day              simulates a day

Prints a row for each kind of trouble. Exit code 1 if memory or descriptors heap up, or a fault is left.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

GROWTH = 8 * 1024 * 1024  # bytes that may be kept more than after the first trouble: allocators do not give all back
PERIOD = 0.2  # s, between looks


def resident_bytes(pid: int) -> int:
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE")


def descriptors(pid: int) -> int:
    return len(os.listdir(f"/proc/{pid}/fd"))


@contextmanager
def running(*commands: list[str]) -> Iterator[None]:
    with ExitStack() as stack:
        for command in commands:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            stack.callback(process.wait)
            stack.callback(process.kill)
        yield


class Soak:
    def __init__(self, hapticd: str, hapticctl: str, config: str, folder: Path) -> None:
        self.hapticctl = hapticctl
        self.socket = str(folder / "s")
        self.folder = folder
        self.daemon = subprocess.Popen([hapticd, "run", "--config", config, "--socket", self.socket],
                                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        while self.ctl("status").returncode == 5:
            time.sleep(0.05)

    def command(self, *arguments: str) -> list[str]:
        return [self.hapticctl, "--socket", self.socket, *arguments]

    def ctl(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(self.command(*arguments), capture_output=True, text=True, check=False)

    def stats(self) -> dict[str, object]:
        return json.loads(self.ctl("stats", "--json").stdout)

    # kinds of trouble; each is called again and again until its time is up

    def nothing(self) -> None:
        time.sleep(PERIOD)

    def hogs(self) -> None:
        with running(*[["sh", "-c", "while :; do :; done"]] * (2 * (os.cpu_count() or 1))):
            time.sleep(10 * PERIOD)

    def memory(self) -> None:
        with running([sys.executable, "-c", "import time\nx = bytearray(1 << 30)\nx[::4096] = b'1' * (1 << 18)\n"
                                            "time.sleep(60)"]):
            time.sleep(10 * PERIOD)

    def watchers(self) -> None:
        with running(*[self.command("watch", "--json")] * 8):
            time.sleep(PERIOD)  # and then killed

    def drivers(self) -> None:
        script = self.folder / "drive.script"
        script.write_text("arm\nwait 60s\n")
        with running(self.command("run", str(script))):
            time.sleep(2 * PERIOD)  # and then killed while it drives
        time.sleep(PERIOD)
        self.ctl("clear")

    def recorders(self) -> None:
        with running(self.command("record", str(self.folder / f"{time.monotonic_ns()}.mcap"), "--seconds", "60")):
            time.sleep(2 * PERIOD)
        for file in self.folder.glob("*.mcap*"):
            file.unlink()

    def edits(self) -> None:
        for y in (-1.62, -9.81):
            self.ctl("gravity", "set", "0", str(y), "0")

    def stops(self) -> None:
        self.daemon.send_signal(signal.SIGSTOP)
        time.sleep(0.02)
        self.daemon.send_signal(signal.SIGCONT)
        time.sleep(PERIOD)

    def trouble(self) -> list[Callable[[], None]]:
        return [self.nothing, self.hogs, self.memory, self.watchers, self.drivers, self.recorders, self.edits,
                self.stops]

    def serve(self, seconds: float) -> bool:
        print(f"{'trouble':<10} {'ticks':>9} {'missed':>7} {'tick p50 us':>12} {'p99 us':>8} {'resident kB':>12} "
              f"{'files':>6}")
        first_bytes = first_files = 0
        kinds = self.trouble()
        for kind in [*kinds, self.nothing]:
            self.ctl("stats", "--reset")
            before = self.stats()
            end = time.monotonic() + seconds / (len(kinds) + 1)
            while time.monotonic() < end:
                kind()
            time.sleep(1.0)
            after = self.stats()
            stage = next(one for one in after["stage"] if one["name"] == "tick")
            used, files = resident_bytes(self.daemon.pid), descriptors(self.daemon.pid)
            first_bytes, first_files = first_bytes or used, first_files or files
            print(f"{kind.__name__:<10} {int(after['tick']) - int(before['tick']):>9} "
                  f"{int(after.get('missed_ticks', 0)):>7} {int(stage['p50_ns']) / 1e3:>12.1f} "
                  f"{int(stage['p99_ns']) / 1e3:>8.1f} {used // 1024:>12} {files:>6}", flush=True)
        status = json.loads(self.ctl("status", "--json").stdout)
        self.daemon.terminate()
        sound = self.daemon.wait() == 0
        sound = report("resident memory", first_bytes, used, GROWTH) and sound
        sound = report("descriptors", first_files, files, 0) and sound
        if status.get("fault"):
            print(f"left: {status['fault']}")
            sound = False
        return sound


def report(what: str, first: int, last: int, permitted: int) -> bool:
    heaps_up = last > first + permitted
    print(f"{what}: {first} at first, {last} at last{': heaps up' if heaps_up else ''}")
    return not heaps_up


def simulate_a_day(hapticd: str, config: str) -> bool:
    begin = time.monotonic()
    process = subprocess.Popen([hapticd, "simulate", "--config", config, "--duration", "86400"],
                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    time.sleep(5.0)
    first = last = resident_bytes(process.pid)
    while process.poll() is None:
        last = resident_bytes(process.pid) or last
        time.sleep(PERIOD)
    print(f"a day in {time.monotonic() - begin:.0f} s, exit code {process.returncode}")
    return report("resident memory", first, last, GROWTH) and process.returncode == 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hapticd")
    parser.add_argument("hapticctl")
    parser.add_argument("config")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--day", action="store_true")
    chosen = parser.parse_args()
    if chosen.day:
        return 0 if simulate_a_day(chosen.hapticd, chosen.config) else 1
    with tempfile.TemporaryDirectory() as folder:
        return 0 if Soak(chosen.hapticd, chosen.hapticctl, chosen.config, Path(folder)).serve(chosen.seconds) else 1


if __name__ == "__main__":
    sys.exit(main())
