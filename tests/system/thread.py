"""One thread of a process, halted while the others go on: what no signal can do, a debugger can."""

import ctypes
import os
import time
from contextlib import contextmanager, suppress
from pathlib import Path

PTRACE_SEIZE, PTRACE_INTERRUPT, PTRACE_DETACH = 0x4206, 0x4207, 17
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
