"""Devices that the kernel of the machine finds: driven through the real udev, libusb and hidraw, under the rights that
the packages give and no others."""

import json
from pathlib import Path

from emulated_tracker import EmulatedTracker
from machine import eventually
from service_cases import CONFIG, FAULT_LATCHED, SERVICE, OnTheMachine

HERE = Path(__file__).resolve().parent
PLACE = "/usr/local/lib/tests"
FIRMWARE = f"{PLACE}/falcon_firmware.bin"
SCENE = f"{PLACE}/wall.scene.txtpb"

WALL, DEPTH, STIFFNESS = -0.015, 0.003, 300.0  # m, the front of the box; m; N/m
CENTRE = 0.125  # m, of a Falcon's workspace on its own axis; the world's origin by `base` below

# emulated machines stand still for some ms, which is not what is tested
CONFIGURED = f"""
servo {{ rate_hz: 1000 priority: 80 lock_memory: true }}
device {{ name: "falcon" falcon {{ firmware: "{FIRMWARE}" }} base {{ position {{ z: {-CENTRE} }} }} }}
device {{ name: "mouse" spacemouse {{ speed: 0.1 reach: 0.2 }} }}
device {{ name: "tracker" fastrak {{ port: "/dev/ttyUSB0" }} }}
safety {{ max_sample_age: 5 max_missed_ticks: 100000 }}
listen {{
  unix {{
    path: "/run/hapticd/hapticd.sock"
    allow {{ group: "haptic" role: DRIVE }}
    allow {{ group: "haptic-view" role: OBSERVE }}
  }}
}}
scene: "{SCENE}"
"""
SCENE_TEXT = f"""
name: "wall"
material {{ name: "air" free {{}} }}
material {{ name: "wood" rigid {{ static_friction: 0.6 kinetic_friction: 0.4 }} }}
object {{
  name: "wall"
  shape {{ box {{ size {{ x: 0.06 y: 0.06 z: 0.03 }} }} }}
  inside: "wood"
  outside: "air"
  air_margin: 0.02
  pose {{ position {{ z: {WALL - 0.015} }} orientation {{ w: 1 }} }}
}}
finger {{ name: "point" device: "falcon" stiffness: {STIFFNESS} point {{}} }}
finger {{ name: "pointer" device: "mouse" stiffness: {STIFFNESS} point {{}} }}
"""


def add_devices(system, falcon):
    if not falcon.exists():
        raise AssertionError(f"there is no {falcon}; ./dev test --system builds it")
    system.add(falcon, f"{PLACE}/emulated_falcon")
    system.add(HERE / "emulated_spacemouse.py", f"{PLACE}/emulated_spacemouse.py")
    system.write(SCENE, SCENE_TEXT)
    system.file(FIRMWARE).write_bytes(bytes(number * 3 % 256 for number in range(150)))


class WithDevices(OnTheMachine):
    """The daemon runs before anything is plugged in, and before the kernel knows such devices."""

    @classmethod
    def setUpClass(cls):
        cls.shipped = cls.machine.read(CONFIG)
        cls.machine.write(CONFIG, CONFIGURED)
        cls.machine.run("systemctl", "restart", SERVICE)

    @classmethod
    def tearDownClass(cls):
        cls.machine.write(CONFIG, cls.shipped)
        cls.machine.run("systemctl", "restart", SERVICE)

    def start(self, *command):
        process = self.machine.start(*command)
        self.addCleanup(process.end)
        return process

    def device(self, name):
        return json.loads(self.run("hapticctl", "--json", "devices", "show", name, user="viewer").stdout)

    def wait_for(self, name, *phases):
        last = {}

        def is_there():
            last.update(self.device(name))
            return last["phase"] in phases

        try:
            eventually(is_there, f"{name} is {' or '.join(phases)}", 30.0)
        except AssertionError as error:
            raise AssertionError(f"{error}; it is {last['phase']}: {last['reason']}\n"
                                 f"{self.machine.journal(SERVICE)[-3000:]}") from None

    def position(self, name):
        at = self.device(name)["pose"]["position"]
        return at["x"], at["y"], at["z"]

    def expect_position(self, name, wanted, within):
        last = []

        def is_there():
            last[:] = self.position(name)
            return all(abs(a - b) < within for a, b in zip(last, wanted))

        try:
            eventually(is_there, f"{name} is at {wanted}", 20.0)
        except AssertionError as error:
            raise AssertionError(f"{error}; it is at {last}") from None


class Falcon(WithDevices):
    """On USB, by USB/IP and the kernel's virtual host controller."""

    def setUp(self):
        super().setUp()
        self.run("modprobe", "vhci_hcd")
        self.wait_for("falcon", "DEVICE_ABSENT")
        self.falcon = self.start(f"{PLACE}/emulated_falcon", FIRMWARE)
        self.addCleanup(self.ctl, "driver", "disarm")

    def plug_in(self):
        self.falcon.ask("plug")
        self.wait_for("falcon", "DEVICE_HOMING", "DEVICE_FAULT")
        self.falcon.ask("homed 7")

    def arm_before_the_wall(self):
        self.falcon.ask(f"hold 0 0 {CENTRE}")
        self.plug_in()
        self.wait_for("falcon", "DEVICE_READY")
        self.expect_position("falcon", (0.0, 0.0, 0.0), 1e-4)
        self.arm()
        self.wait_for("falcon", "DEVICE_ARMED")

    def press(self):
        self.falcon.ask(f"hold 0 0 {CENTRE + WALL - DEPTH} 1")
        felt = []

        def is_pushed_back():
            felt[:] = self.falcon.ask("report")["force"]
            return abs(felt[2] - STIFFNESS * DEPTH) < 0.05 and abs(felt[0]) < 0.05 and abs(felt[1]) < 0.05

        try:
            eventually(is_pushed_back, f"the hand feels {STIFFNESS * DEPTH:g} N", 30.0)
        except AssertionError as error:
            raise AssertionError(f"{error}, but {felt}\n{self.device('falcon')}") from None

    def test_its_node_belongs_to_a_group_of_the_daemon_and_not_to_everybody(self):
        self.falcon.ask("plug")
        rights = ("sh", "-c", "for device in /sys/bus/usb/devices/*; do grep -qs cb48 $device/idProduct && "
                  "stat -c '%G %a' /dev/$(sed -n s/^DEVNAME=//p $device/uevent); done; true")
        eventually(lambda: self.run(*rights).stdout == "plugdev 660\n", "its node has its group", 20.0)
        groups = self.run("cat", f"/proc/{self.main_process()}/status").stdout
        plugdev = self.run("getent", "group", "plugdev").stdout.split(":")[2]
        self.assertIn(plugdev, groups.split("Groups:")[1].splitlines()[0].split())

    def test_plugged_in_it_gets_its_firmware_and_asks_to_be_homed(self):
        self.assertFalse(self.falcon.ask("report")["running"])
        self.falcon.ask("plug")
        self.wait_for("falcon", "DEVICE_HOMING")
        self.assertTrue(self.falcon.ask("report")["running"])
        self.assertIn("pull its grip out", self.device("falcon")["reason"])
        self.assertEqual(self.device("falcon")["serial"], "FALCON01")

    def test_homed_it_tells_where_the_hand_is(self):
        self.plug_in()
        self.falcon.ask(f"hold 0.01 -0.02 {CENTRE + 0.01}")
        self.wait_for("falcon", "DEVICE_READY")
        self.expect_position("falcon", (0.01, -0.02, 0.01), 2e-4)
        self.assertEqual(self.falcon.ask("report")["broken"], 0)

    def test_armed_it_pushes_the_hand_out_of_a_wall(self):
        self.arm_before_the_wall()
        self.press()
        self.ctl("driver", "disarm")
        eventually(lambda: self.falcon.ask("report")["motors"] == [0, 0, 0], "the motors are off", 10.0)

    def test_pulled_out_while_it_pushes_it_is_a_fault_and_plugged_in_again_it_is_not_armed(self):
        self.arm_before_the_wall()
        self.press()
        self.falcon.ask("unplug")
        eventually(lambda: not self.is_armed(), "force ends", 10.0)
        faults = json.loads(self.run("hapticctl", "--json", "status", user="viewer").stdout)["fault"]
        self.assertEqual([(fault["kind"], fault["device"]) for fault in faults], [("FAULT_LOST_DEVICE", "falcon")])

        self.falcon.ask(f"hold 0 0 {CENTRE}")
        self.plug_in()
        self.expect_position("falcon", (0.0, 0.0, 0.0), 1e-4)
        self.assertFalse(self.is_armed())
        self.assertEqual(self.ctl("driver", "arm").returncode, FAULT_LATCHED)
        self.run("hapticctl", "clear")
        self.wait_for("falcon", "DEVICE_READY")
        self.assertFalse(self.is_armed())
        self.assertEqual(self.falcon.ask("report")["motors"], [0, 0, 0])

    def test_without_its_udev_rule_it_is_told_who_may_not_open_it(self):
        rules = "/usr/lib/udev/rules.d/70-hapticd.rules"
        text = self.machine.read(rules)

        def put_back():
            self.machine.write(rules, text)
            self.run("udevadm", "control", "--reload")

        self.addCleanup(put_back)
        self.machine.write(rules, "")
        self.run("udevadm", "control", "--reload")
        self.falcon.ask("plug")
        self.wait_for("falcon", "DEVICE_FOUND")
        self.assertIn("no permission to open the USB device 0403:cb48", self.device("falcon")["reason"])


class Spacemouse(WithDevices):
    """By the kernel's uhid."""

    def setUp(self):
        super().setUp()
        self.wait_for("mouse", "DEVICE_ABSENT")
        self.run("modprobe", "uhid")
        self.mouse = self.start("/usr/bin/python3", "-B", f"{PLACE}/emulated_spacemouse.py")

    def test_its_node_belongs_to_a_group_of_the_daemon_and_not_to_everybody(self):
        self.mouse.ask("plug")
        eventually(lambda: self.run("sh", "-c", "stat -c '%G %a' /dev/hidraw*", check=False).stdout == "plugdev 660\n",
                   "its node has its group", 10.0)

    def test_plugged_in_it_is_found_and_lit(self):
        self.mouse.ask("plug")
        self.wait_for("mouse", "DEVICE_READY")
        self.assertEqual(self.device("mouse")["serial"], "MOUSE01")
        eventually(lambda: self.mouse.ask("report")["lit"], "its LED is on", 10.0)

    def test_pushed_it_moves_the_point_of_its_finger(self):
        self.mouse.ask("plug")
        self.wait_for("mouse", "DEVICE_READY")
        before = self.hip()
        self.mouse.ask("push 175 0 0")
        eventually(lambda: self.hip()[0] > before[0] + 0.02, "it has gone 20 mm to the right", 20.0)
        self.mouse.ask("push 0 0 0")
        there = self.hip()
        self.assertAlmostEqual(there[1], before[1], delta=1e-9)
        self.assertAlmostEqual(there[2], before[2], delta=1e-9)

    def test_pulled_out_it_is_gone_and_plugged_in_again_it_is_found(self):
        for losses in (1, 2):
            self.mouse.ask("plug")
            self.wait_for("mouse", "DEVICE_READY")
            before = int(self.device("mouse")["losses"])
            self.mouse.ask("unplug")
            self.wait_for("mouse", "DEVICE_ABSENT", "DEVICE_FOUND")
            self.assertEqual(int(self.device("mouse")["losses"]), before + 1, losses)

    def hip(self):
        told = self.run("python3", "-c", "import asyncio, haptic\n"
                        "async def main():\n"
                        "    async with haptic.connect() as daemon:\n"
                        "        async with daemon.subscribe([haptic.Topic.HIPS], fingers=['pointer']) as frames:\n"
                        "            async for frame in frames:\n"
                        "                print(*frame.hips.position[0])\n"
                        "                return\n"
                        "asyncio.run(main())", user="viewer").stdout
        return [float(word) for word in told.split()]


class Fastrak(WithDevices):
    """On the USB serial port that QEMU has, of FTDI's kind."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.tracker = EmulatedTracker(cls.machine.serial)

    def setUp(self):
        super().setUp()
        self.addCleanup(self.pull_out)
        self.plug_in()

    def plug_in(self):
        self.run("modprobe", "xhci_pci")
        self.wait_for("tracker", "DEVICE_READY")

    def pull_out(self):
        # absent in what the daemon tells, it has let go of the port: the next one gets the same name
        self.run("modprobe", "-r", "xhci_pci")
        self.wait_for("tracker", "DEVICE_ABSENT")

    def test_plugged_in_it_is_found_and_tells_where_its_station_is(self):
        self.tracker.place = (10.0, -5.0, 20.0)
        self.expect_position("tracker", (0.1, -0.05, 0.2), 1e-6)
        self.tracker.place = (12.5, -5.0, 20.0)
        self.expect_position("tracker", (0.125, -0.05, 0.2), 1e-6)

    def test_its_node_belongs_to_a_group_of_the_daemon_and_not_to_everybody(self):
        eventually(lambda: self.run("stat", "-c", "%G %a", "/dev/ttyUSB0", check=False).stdout == "dialout 660\n",
                   "its node has its group", 20.0)

    def test_pulled_out_it_is_gone_and_plugged_in_again_it_is_found(self):
        self.pull_out()
        self.plug_in()


CASES = (Falcon, Spacemouse, Fastrak)
