#!/usr/bin/python3
"""One thread of a process, halted while the others go on: what no signal can do, a debugger can.

usage: thread.py PROCESS    halts its busiest thread until the process is gone, for 20 s at the most, and tells how many
                            times a second that thread ran
"""

import ctypes
import os
import sys
import time
from contextlib import contextmanager, suppress
from pathlib import Path

PTRACE_SEIZE, PTRACE_INTERRUPT, PTRACE_DETACH = 0x4206, 0x4207, 17
PATIENCE = 20.0  # s
WALL = 0x40000000  # linux/wait.h: threads as well

LIBC = ctypes.CDLL(None, use_errno=True)
LIBC.ptrace.argtypes = [ctypes.c_ulong, ctypes.c_ulong, ctypes.c_void_p, ctypes.c_void_p]
LIBC.ptrace.restype = ctypes.c_long


def ptrace(request, thread):
    if LIBC.ptrace(request, thread, None, None) != 0:
        raise OSError(ctypes.get_errno(), f"ptrace request {request:#x} of thread {thread}")


def sleeps(process):
    """How often each thread has gone to sleep by itself."""
    counts = {}
    for status in Path(f"/proc/{process}/task").glob("*/status"):
        for line in status.read_text(encoding="utf-8").splitlines():
            if line.startswith("voluntary_ctxt_switches:"):
                counts[int(status.parent.name)] = int(line.split()[1])
    return counts


def busiest_thread(process, seconds=1.0):
    """The one that sleeps most often, once for each tick, and how many times a second."""
    before = sleeps(process)
    time.sleep(seconds)
    rates = {thread: (count - before.get(thread, count)) / seconds for thread, count in sleeps(process).items()}
    thread = max(rates, key=rates.get)
    return thread, rates[thread]


@contextmanager
def halted(thread):
    ptrace(PTRACE_SEIZE, thread)
    try:
        ptrace(PTRACE_INTERRUPT, thread)
        os.waitpid(thread, WALL)
        yield
    finally:
        try:
            ptrace(PTRACE_DETACH, thread)
        except OSError:
            # it was killed meanwhile, and is gone for its process when who traced it has seen that
            with suppress(ChildProcessError):
                os.waitpid(thread, WALL)


def has_ended(process, thread):
    """Or is only still there for who traces it to see that."""
    try:
        return "State:\tZ" in Path(f"/proc/{process}/task/{thread}/status").read_text(encoding="utf-8")
    except (FileNotFoundError, ProcessLookupError):
        return True


def main(process):
    thread, rate = busiest_thread(process)
    print(rate)
    deadline = time.monotonic() + PATIENCE
    with halted(thread):
        while not has_ended(process, thread):
            if time.monotonic() > deadline:
                sys.exit(f"process {process} has not minded for {PATIENCE:g} s")
            time.sleep(0.1)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(int(sys.argv[1]))
