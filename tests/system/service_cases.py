"""What the packages promise of the service, on whichever machine."""

import json
import tempfile
import time
import unittest
from pathlib import Path

import package
from machine import eventually

SERVICE, SOCKET = "hapticd.service", "hapticd.socket"
CONFIG = "/etc/hapticd/hapticd.txtpb"
INSTALLED = ("hapticd", "hapticctl", "haptic-view", "haptic-bridge", "python3-haptic")
HALT = "/usr/local/lib/tests/thread.py"  # where the machine has it
BROWSE = "/usr/local/lib/tests/browse.py"
SHIPPED = "/usr/local/lib/tests/shipped.txtpb"  # the config before it was made patient
# exit codes of hapticctl
DONE, NOTHING_TO_DO, REFUSED, UNREACHABLE, FAULT_LATCHED = 0, 2, 4, 5, 7


class OnTheMachine(unittest.TestCase):
    machine = None
    packages = {}

    def setUp(self):
        self.run = self.machine.run
        self.run("systemctl", "reset-failed", SERVICE, check=False)
        self.run("systemctl", "start", SOCKET, SERVICE)

    def ctl(self, user, *arguments):
        return self.run("hapticctl", *arguments, user=user, check=False)

    def main_process(self):
        return int(self.machine.show(SERVICE, "MainPID"))

    def write_config(self, text):
        """Replaces it for the length of a test; the daemon is told by the test."""
        before = self.config()

        def put_back():
            self.machine.write(CONFIG, before)
            self.run("systemctl", "restart", SERVICE)

        self.addCleanup(put_back)
        self.machine.write(CONFIG, text)

    def config(self):
        return self.machine.read(CONFIG)

    def wait_for_new_process(self, old):
        eventually(lambda: self.machine.show(SERVICE, "ActiveState") == "active" and self.main_process() != old,
                   "the daemon is back")

    def arm(self):
        # forces may be near their limit just then: armed is what must be, once
        told = []

        def is_armed():
            told.append(self.ctl("driver", "arm"))
            return told[-1].returncode in (DONE, NOTHING_TO_DO)

        try:
            eventually(is_armed, "the daemon arms", 20.0)
        except AssertionError as error:
            raise AssertionError(f"{error}: {told[-1].stdout}") from None

    def is_armed(self):
        return json.loads(self.run("hapticctl", "--json", "status", user="viewer").stdout).get("armed", False)


class Service(OnTheMachine):
    def test_is_ready_after_boot_as_its_own_user_without_any_capability(self):
        self.assertEqual(self.machine.show(SERVICE, "ActiveState"), "active")
        self.assertEqual(self.machine.show(SERVICE, "StatusText"), "2 devices at 1000 Hz")
        process = self.main_process()
        status = self.run("cat", f"/proc/{process}/status").stdout
        user = self.run("id", "-u", "hapticd").stdout.strip()
        self.assertIn(f"Uid:\t{user}\t{user}\t{user}\t{user}", status)
        for kind in ("CapInh", "CapPrm", "CapEff", "CapBnd", "CapAmb"):
            self.assertIn(f"{kind}:\t0000000000000000", status)
        self.assertIn("NoNewPrivs:\t1", status)
        self.assertIn("Seccomp:\t2", status)

    def test_tells_ready_only_when_the_servo_thread_keeps_its_period(self):
        self.run("systemctl", "stop", SERVICE)
        since = self.machine.now()
        self.run("systemctl", "start", SERVICE)  # comes back when it is ready
        self.assertRegex(self.machine.journal(SERVICE, since), r"ready: the servo thread runs (9|10)\d\d ticks")

    def test_has_its_directories(self):
        for path, owner, mode in (("/run/hapticd", "hapticd", "755"), ("/var/lib/hapticd", "hapticd", "750"),
                                  ("/var/log/hapticd", "hapticd", "750"), ("/etc/hapticd", "root", "755")):
            self.assertEqual(self.run("stat", "-c", "%U %a", path).stdout.strip(), f"{owner} {mode}", path)

    def test_cannot_write_elsewhere_nor_read_homes(self):
        process = self.main_process()
        inside = ("nsenter", f"--target={process}", "--mount", "--")
        self.assertNotEqual(self.run(*inside, "touch", "/usr/evil", check=False).returncode, 0)
        self.assertNotEqual(self.run(*inside, "touch", "/etc/evil", check=False).returncode, 0)
        self.assertNotEqual(self.run("touch", "/etc/hapticd/evil", user="hapticd", check=False).returncode, 0)
        self.assertEqual(self.run(*inside, "ls", "-A", "/home", check=False).stdout, "")

    def test_check_finds_the_shipped_config_right(self):
        self.run("hapticd", "check", "--config", SHIPPED)


class Roles(OnTheMachine):
    def test_a_driver_arms_and_disarms(self):
        self.arm()
        self.assertEqual(self.ctl("driver", "disarm").returncode, DONE)

    def test_a_viewer_observes_and_is_refused_to_arm(self):
        self.assertEqual(self.ctl("viewer", "status").returncode, DONE)
        self.assertEqual(self.ctl("viewer", "arm").returncode, REFUSED)
        self.assertFalse(self.is_armed())

    def test_a_stranger_does_not_even_connect(self):
        refused = self.ctl("stranger", "status")
        self.assertEqual(refused.returncode, UNREACHABLE)
        self.assertIn("permission denied", refused.stdout)

    def test_python_observes_as_its_user(self):
        told = self.run("python3", "-c", "import asyncio, haptic\n"
                        "async def main():\n"
                        "    async with haptic.connect() as daemon:\n"
                        "        print((await daemon.status()).clients)\n"
                        "asyncio.run(main())", user="viewer")
        self.assertEqual(told.stdout.strip(), "1")


class Sockets(OnTheMachine):
    def test_a_client_wakes_the_daemon_that_was_stopped(self):
        self.run("systemctl", "stop", SERVICE)
        self.assertEqual(self.machine.show(SERVICE, "ActiveState"), "inactive")
        self.assertEqual(self.ctl("viewer", "status").returncode, DONE)
        # who waits in the socket is served at once, and the daemon tells that it is ready when it knows that it ticks
        eventually(lambda: self.machine.show(SERVICE, "ActiveState") == "active", "the daemon is ready", 20.0)

    def test_the_daemon_opens_its_own_socket_where_the_socket_unit_is_disabled(self):
        self.run("systemctl", "stop", SERVICE, SOCKET)
        self.run("systemctl", "mask", "--runtime", SOCKET)
        self.addCleanup(self.run, "systemctl", "stop", SERVICE)
        self.addCleanup(self.run, "systemctl", "unmask", "--runtime", SOCKET)
        self.run("systemctl", "start", SERVICE)
        self.assertEqual(self.ctl("viewer", "status").returncode, DONE)
        self.assertEqual(self.ctl("stranger", "status").returncode, UNREACHABLE)


class Failures(OnTheMachine):
    def test_a_daemon_that_is_killed_comes_back_disarmed(self):
        self.arm()
        old = self.main_process()
        self.run("systemctl", "kill", "--kill-whom=main", "--signal=KILL", SERVICE)
        self.wait_for_new_process(old)
        self.assertFalse(self.is_armed())

    def test_a_daemon_that_hangs_is_killed_by_the_watchdog_and_comes_back_disarmed(self):
        self.arm()
        old = self.main_process()
        since = self.machine.now()
        self.run("systemctl", "kill", "--kill-whom=main", "--signal=STOP", SERVICE)
        self.wait_for_new_process(old)
        self.assertIn("Watchdog timeout", self.machine.journal(SERVICE, since))
        self.assertFalse(self.is_armed())

    def test_a_servo_thread_that_hangs_alone_is_enough(self):
        old = self.main_process()
        since = self.machine.now()
        halted = self.run("python3", "-B", HALT, old)  # until the process is gone
        self.assertGreater(float(halted.stdout), 500.0)  # Hz; the io thread polls at that rate
        self.assertIn("Watchdog timeout", self.machine.journal(SERVICE, since))
        self.wait_for_new_process(old)

    def test_a_wrong_config_is_told_by_line_and_not_tried_for_ever(self):
        self.write_config("servo {\n  rate_hz: 9e9\n}\n")
        since = self.machine.now()
        self.run("systemctl", "restart", SERVICE, check=False)
        eventually(lambda: self.machine.show(SERVICE, "ActiveState") == "failed", "it gives up")
        self.assertIn(f"{CONFIG}:2:3: servo.rate_hz", self.machine.journal(SERVICE, since))
        self.run("systemctl", "reset-failed", SERVICE, SOCKET, check=False)


class Reload(OnTheMachine):
    def test_takes_over_who_may_come_in_and_tells_what_needs_a_restart(self):
        self.assertEqual(self.ctl("viewer", "status").returncode, DONE)
        process = self.main_process()
        config = self.config()
        changed = config.replace('    allow { group: "haptic-view" role: OBSERVE }\n', "")
        self.assertNotEqual(changed, config)
        self.write_config(changed.replace("rate_hz: 1000", "rate_hz: 500"))
        since = self.machine.now()
        self.run("systemctl", "reload", SERVICE)
        eventually(lambda: self.ctl("viewer", "status").returncode == UNREACHABLE, "the group is out", 20.0)
        self.assertEqual(self.ctl("driver", "status").returncode, DONE)
        journal = self.machine.journal(SERVICE, since)
        self.assertIn("changed: listen[0].unix.allow[1]", journal)
        self.assertIn("changed, but needs a restart: servo.rate_hz", journal)
        self.assertEqual((self.main_process(), self.machine.show(SERVICE, "ActiveState")), (process, "active"))

    def test_keeps_everything_if_the_config_is_wrong(self):
        process = self.main_process()
        self.write_config(self.config() + "\nnonsense { }\n")
        since = self.machine.now()
        self.run("systemctl", "reload", SERVICE)
        eventually(lambda: "the config stays as it was" in self.machine.journal(SERVICE, since), "it is told", 20.0)
        self.assertEqual(self.ctl("viewer", "status").returncode, DONE)
        self.assertEqual(self.main_process(), process)


class View(OnTheMachine):
    UNIT = "haptic-view.service"

    def test_is_off_until_somebody_wants_it(self):
        self.assertEqual(self.run("systemctl", "is-enabled", self.UNIT, check=False).stdout.strip(), "disabled")

    def start(self):
        self.addCleanup(self.run, "systemctl", "stop", self.UNIT)
        since = time.time()
        self.run("systemctl", "start", self.UNIT)
        eventually(lambda: "serves http://127.0.0.1:8765" in self.machine.journal(self.UNIT, since), "it listens", 20.0)

    def browse(self, *token):
        return json.loads(self.run("python3", BROWSE, "127.0.0.1", "8765", *token).stdout)

    def test_shows_the_page_and_the_daemon_as_a_user_of_its_own(self):
        self.start()
        self.assertEqual(self.browse(), {"page": "text/html", "script": "text/javascript",
                                         "upgrade": "HTTP/1.1 101 Switching Protocols", "role": "OBSERVE"})
        process = self.machine.show(self.UNIT, "MainPID")
        self.assertNotIn("Uid:\t0\t", self.run("cat", f"/proc/{process}/status").stdout)

    def test_lets_a_page_drive_with_a_token_as_the_manual_tells(self):
        folder, token = f"/etc/systemd/system/{self.UNIT}.d", "0123456789abcdef"
        self.addCleanup(self.run, "systemctl", "daemon-reload")
        self.addCleanup(self.run, "rm", "-r", folder)
        self.run("install", "-d", folder, "/etc/haptic-view")
        self.machine.write("/etc/haptic-view/token", f"{token}\n")
        self.machine.write(f"{folder}/drive.conf",
                           "[Service]\nGroup=haptic\nLoadCredential=token:/etc/haptic-view/token\nExecStart=\n"
                           "ExecStart=/usr/bin/haptic-view --server /run/hapticd/hapticd.sock "
                           "--drive-token-file %d/token\n")
        self.run("systemctl", "daemon-reload")
        self.start()
        self.assertEqual(self.browse()["role"], "OBSERVE")
        self.assertEqual(self.browse(token)["role"], "DRIVE")


class Bridge(OnTheMachine):
    def test_waits_for_its_broker_as_a_user_of_its_own(self):
        unit = "haptic-bridge@local.service"
        self.addCleanup(self.run, "systemctl", "stop", unit)
        self.run("systemctl", "start", unit)
        time.sleep(1.0)  # s; there is no broker on the machine, and it must not mind
        self.assertEqual(self.machine.show(unit, "ActiveState"), "active", self.machine.journal(unit))
        self.assertEqual(self.machine.show(unit, "NRestarts"), "0")


class Upgrade(OnTheMachine):
    def install(self, version, changes=None):
        with tempfile.TemporaryDirectory() as folder:
            later = package.later_version(self.packages["hapticd"], version, Path(folder), changes)
            self.machine.write("/packages/later.deb", later.read_bytes())
        self.run("dpkg", "--force-confdef", "--force-confold", "-i", "/packages/later.deb")

    def test_keeps_a_config_that_was_edited_and_restarts_the_daemon(self):
        edited = self.config() + "# by hand\n"
        self.machine.write(CONFIG, edited)
        old = self.main_process()
        self.install("9:1")
        self.assertEqual(self.config(), edited)
        self.wait_for_new_process(old)
        self.assertEqual(self.ctl("viewer", "status").returncode, DONE)

        self.install("9:2", {CONFIG: "# another default\n"})
        self.assertEqual(self.config(), edited)
        self.assertEqual(self.machine.read(f"{CONFIG}.dpkg-dist"), "# another default\n")
        self.run("rm", f"{CONFIG}.dpkg-dist")


class Removal(OnTheMachine):
    def test_purge_leaves_nothing_but_the_user_and_the_groups(self):
        self.run("apt-get", "-q", "-y", "remove", *INSTALLED)
        self.assertNotEqual(self.run("systemctl", "is-active", SERVICE, check=False).returncode, 0)
        self.assertTrue(self.machine.exists(CONFIG))  # a config outlives the removal
        self.run("dpkg", "--purge", *INSTALLED)
        self.run("rm", "-rf", "/packages", f"/etc/systemd/system/{SERVICE}.d")
        left = self.run("find", "/", "/run", "-xdev", "-iname", "*haptic*")
        self.assertEqual(left.stdout, "")
        self.assertEqual(self.run("getent", "passwd", "hapticd").returncode, 0)


# in this order: the last ones leave no service behind
FIRST = (Service, Roles, Sockets, Failures, Reload, View, Bridge)
LAST = (Upgrade, Removal)
