#!/usr/bin/env python3
"""Systemd's own judgement of the units: that they say what systemd understands, and how little is left open to them.

usage: units_test.py FOLDER BINDIR    the folder of the units as they are installed, and where their programs will be
Exit code 77 where there is no systemd-analyze.
"""

import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

# of 10, the least hardened; as `systemd-analyze security` counts it
MOST_EXPOSURE = 2.0
# a misspelt key is an error on standard error only, and systemd's exit code is 0
PROGRAMS = ("hapticd", "haptic-view", "haptic-bridge")


def analyze(*arguments):
    return subprocess.run(["systemd-analyze", *map(str, arguments)], capture_output=True, text=True, check=False)


class Units(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        # the programs are not installed yet: something executable stands in their places
        for name in PROGRAMS:
            (self.folder / name).write_text("#!/bin/sh\n", encoding="utf-8")
            (self.folder / name).chmod(0o755)
        self.units = []
        for unit in sorted(UNITS.glob("*.s*")):
            if unit.suffix in (".service", ".socket"):
                text = unit.read_text(encoding="utf-8").replace(f"={BINDIR}/", f"={self.folder}/")
                self.units.append(self.folder / unit.name)
                self.units[-1].write_text(text, encoding="utf-8")

    def test_all_of_them_are_there(self):
        self.assertEqual([unit.name for unit in self.units],
                         ["haptic-bridge@.service", "haptic-view.service", "hapticd.service", "hapticd.socket"])

    def test_systemd_understands_every_line(self):
        for unit in self.units:
            with self.subTest(unit.name):
                verdict = analyze("verify", "--man=no", unit)
                told = [line for line in verdict.stderr.splitlines() if str(self.folder) in line or unit.name in line]
                self.assertEqual((verdict.returncode, told), (0, []), verdict.stderr)

    def test_a_misspelt_line_would_be_noticed(self):
        unit = self.folder / "hapticd.service"
        unit.write_text(unit.read_text(encoding="utf-8").replace("ProtectHome=", "ProtectHone="), encoding="utf-8")
        self.assertIn("ProtectHone", analyze("verify", "--man=no", unit).stderr)

    def test_services_are_open_to_little(self):
        for unit in self.units:
            if unit.suffix == ".service":
                with self.subTest(unit.name):
                    verdict = analyze("security", "--offline=true", f"--threshold={MOST_EXPOSURE * 10:.0f}", unit)
                    self.assertEqual(verdict.returncode, 0, verdict.stdout)

    def test_the_daemon_has_no_capability(self):
        text = (self.folder / "hapticd.service").read_text(encoding="utf-8")
        self.assertIn("\nCapabilityBoundingSet=\n", text)
        self.assertIn("\nAmbientCapabilities=\n", text)
        self.assertIn("\nUser=hapticd\n", text)

    def test_kinds_of_device_are_allowed_before_the_first_such_device_is_plugged_in(self):
        text = (self.folder / "hapticd.service").read_text(encoding="utf-8")
        kinds = re.findall(r"^DeviceAllow=char-(\S+) rw$", text, re.MULTILINE)
        by_name = [kind for kind in kinds if not kind.isdigit()]
        self.assertEqual(sorted(set(kinds) - set(by_name)), ["166", "188", "189"])
        # whose module is loaded first, of which hidraw is a part of hid
        for kind in by_name:
            module = {"hidraw": "hid"}.get(kind, kind)
            for order in ("Wants", "After"):
                self.assertRegex(text, rf"(?m)^{order}=.*\bmodprobe@{module}\.service")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        sys.exit(64)
    UNITS, BINDIR = Path(sys.argv[1]), sys.argv[2]
    if shutil.which("systemd-analyze") is None:
        print("skipped: there is no systemd-analyze")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
