#!/usr/bin/env python3
"""The packages on a bare Debian 12 with its own systemd: installed, started, used, killed, upgraded, removed.

usage: system_test.py container|qemu PACKAGES CACHE [unittest's arguments]

container: systemd-nspawn, fast; where root may not raise limits, as in many containers, the daemon runs without
real-time rights. qemu: a machine with Debian's own kernel, where devices are plugged in, too; EMULATED_FALCON names the
program that is one. PACKAGES is the folder with the .deb files, CACHE keeps the bare system from one run to the next.
Needs root.
"""

import os
import re
import shutil
import signal
import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import device_cases  # noqa: E402
import package  # noqa: E402
import realtime_cases  # noqa: E402
import service_cases  # noqa: E402
from container import Container  # noqa: E402
from debian import Debian  # noqa: E402
from service_cases import BROWSE, CONFIG, HALT, INSTALLED, SERVICE, SHIPPED, OnTheMachine  # noqa: E402
from virtual_machine import VirtualMachine  # noqa: E402

HERE = Path(__file__).resolve().parent
TOOLS = {"container": ("mmdebstrap", "systemd-nspawn", "nsenter", "dpkg-deb"),
         "qemu": ("mmdebstrap", "systemd-nspawn", "mkfs.ext4", "qemu-system-x86_64", "setpriv", "dpkg-deb")}
# systemd of a container may not raise the limit by which the servo thread gets its priority, but can give one itself
CONTAINER = "[Service]\nCPUSchedulingPolicy=fifo\nCPUSchedulingPriority=20\nLimitRTTIME=infinity\n"
# a machine stands still for as long as its host likes, and what simulated hands do then is wild
PATIENT = ("safety { max_missed_ticks: 100000 max_sample_age: 10 max_speed: 10 max_energy: 100 max_force: 5 "
           "max_arm_force: 20 }")


def load_tests(loader, _tests, _pattern):
    only_there = (*realtime_cases.CASES, *device_cases.CASES) if KIND == "qemu" else ()
    cases = (*service_cases.FIRST, *only_there, *service_cases.LAST)
    return unittest.TestSuite(loader.loadTestsFromTestCase(case) for case in cases)


def prepare(packages):
    """A system with the packages, and what tests use beside them."""
    system = Debian(CACHE, KIND, with_kernel=KIND == "qemu")
    system.install([packages[name] for name in INSTALLED])
    for user, group in (("driver", "haptic"), ("viewer", "haptic-view"), ("stranger", "nogroup")):
        system.run("useradd", "--create-home", "--groups", group, user)
    system.add(HERE / "thread.py", HALT)
    system.add(HERE / "browse.py", BROWSE)
    system.add(system.file(CONFIG), SHIPPED)
    config = system.file(CONFIG).read_text(encoding="utf-8")
    system.write(CONFIG, re.sub(r"(?m)^safety \{.*\}$", PATIENT, config))
    return system


def make_machine(system):
    if KIND == "container":
        system.write(f"/etc/systemd/system/{SERVICE}.d/container.conf", CONTAINER)
        return Container(system.root, CACHE / "container.log")
    device_cases.add_devices(system, FALCON)
    machine = VirtualMachine(system, CACHE)
    system.remove()
    return machine


def run(arguments):
    """All tests on a machine that lives as long as they do; whether they passed."""
    packages = package.find(PACKAGES)
    missing = [name for name in INSTALLED if name not in packages]
    if missing:
        sys.exit(f"{PACKAGES} has no package {', '.join(missing)}; ./dev package makes them")
    begin = time.monotonic()
    system = prepare(packages)
    machine = make_machine(system)
    prepared = time.monotonic()
    try:
        machine.boot()
        booted = time.monotonic()
        print(f"{KIND}: prepared in {prepared - begin:.0f} s, booted in {booted - prepared:.0f} s; {machine.kind()}",
              file=sys.stderr, flush=True)
        OnTheMachine.machine = machine
        OnTheMachine.packages = packages
        done = unittest.main(argv=[sys.argv[0], *arguments], verbosity=2, exit=False)
        print(f"{KIND}: tested in {time.monotonic() - booted:.0f} s", file=sys.stderr)
        return done.result.wasSuccessful()
    finally:
        machine.stop()
        system.remove()


def interrupt(*_):
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    # unittest takes sys.exit() for one more test that fails
    raise KeyboardInterrupt


if __name__ == "__main__":
    if len(sys.argv) < 4 or sys.argv[1] not in TOOLS:
        print(__doc__, file=sys.stderr)
        sys.exit(64)
    KIND, PACKAGES, CACHE = sys.argv[1], Path(sys.argv[2]).resolve(), Path(sys.argv[3]).resolve()
    FALCON = Path(os.environ.get("EMULATED_FALCON", "build/release/tests/system/emulated_falcon")).resolve()
    if os.geteuid() != 0:
        sys.exit("system_test.py: needs root, to make the file system of a machine")
    for tool in TOOLS[KIND]:
        if shutil.which(tool) is None:
            sys.exit(f"system_test.py: there is no {tool}; ./dev test --system installs it")
    signal.signal(signal.SIGTERM, interrupt)
    sys.exit(0 if run(sys.argv[4:]) else 1)
