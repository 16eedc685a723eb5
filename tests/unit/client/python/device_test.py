"""A virtual device in a real hapticd: moved, felt, lost."""

import asyncio
import subprocess
import time
import unittest

import haptic
from haptic import v1
from support import HAPTICCTL, PATIENCE, DaemonTest

# the fixed cube of 40 mm: its top is at 20 mm. 10 mm deep a finger of 100 N/m feels 1 N upwards
ABOVE = (0.001, 0.03, 0.002)
INSIDE = (0.001, 0.01, 0.002)


class VirtualTest(DaemonTest):
    # patient with a test on a machine that is busy; what is stale is tested below
    safety = "safety { max_sample_age: 2 max_force_rate: 1e6 max_speed: 100 arm_ramp: 0.001 }"

    def make_listen(self) -> str:
        return super().make_listen() + self.safety + ' device { name: "mouse" virtual {} }'

    def start(self) -> None:
        scene = self.folder / "press.scene.txtpb"
        scene.write_text(scene.read_text().replace('device: "probe"', 'device: "mouse"'))
        super().start()

    async def press(self, daemon: haptic.Connection) -> v1.DeviceForce:
        """Armed, and inside until the force is as it should be."""
        await daemon.move_device("mouse", ABOVE, velocity=(0.0, 0.0, 0.0))
        await asyncio.sleep(0.05)
        await daemon.arm()
        async with asyncio.timeout(PATIENCE):
            while True:
                force = await daemon.move_device("mouse", INSIDE, velocity=(0.0, 0.0, 0.0))
                if abs(force.wrench.force.y - 1.0) < 1e-9:
                    return force
                await asyncio.sleep(0.001)


class Virtual(VirtualTest):
    async def test_is_absent_until_it_is_moved(self) -> None:
        daemon = await self.connect()
        mouse = (await daemon.devices())[1]
        self.assertEqual(mouse.description.driver, "virtual")
        self.assertFalse(mouse.present)

    async def test_a_client_that_moves_it_gets_the_force(self) -> None:
        daemon = await self.connect()
        force = await self.press(daemon)
        self.assertLessEqual(force.lifetime, 0.003)
        self.assertLess(abs(force.expires_ns - time.monotonic_ns()), PATIENCE * 1e9)
        async with daemon.subscribe([haptic.Topic.DEVICES]) as frames:
            async for one in frames:
                assert one.devices is not None
                self.assertTrue(one.devices.present[1])
                self.assertAlmostEqual(one.devices.force[1, 1], 1.0)
                break

    async def test_the_force_ends_when_it_is_disarmed(self) -> None:
        daemon = await self.connect()
        await self.press(daemon)
        await daemon.disarm()
        async with asyncio.timeout(PATIENCE):
            while (await daemon.move_device("mouse", INSIDE)).wrench.force.y != 0.0:
                await asyncio.sleep(0.001)

    async def test_only_the_holder_of_the_lease_moves_it(self) -> None:
        daemon, other = await self.connect(), await self.connect()
        async with daemon.drive():
            await daemon.move_device("mouse", ABOVE)
            with self.assertRaisesRegex(haptic.Refused, "holds the drive lease"):
                await other.move_device("mouse", ABOVE)

    async def test_another_device_is_not_moved(self) -> None:
        daemon = await self.connect()
        with self.assertRaisesRegex(haptic.Invalid, "driver playback"):
            await daemon.move_device("probe", ABOVE)

    async def test_hapticctl_moves_it_and_holds_it_there(self) -> None:
        daemon = await self.connect()
        process = await asyncio.create_subprocess_exec(
            HAPTICCTL, "--socket", str(self.socket), "device", "move", "mouse", "--at", "0.1", "0.2", "0.3",
            "--hold", "0.5", stdout=subprocess.PIPE)
        async with asyncio.timeout(PATIENCE):
            while True:
                mouse = (await daemon.devices())[1]
                if mouse.present:
                    break
                await asyncio.sleep(0.01)
        self.assertEqual(mouse.pose.position, v1.Vector3(x=0.1, y=0.2, z=0.3))
        out, _ = await process.communicate()
        self.assertEqual(process.returncode, 0)
        self.assertEqual(out.decode(), "mouse was moved; it pushes by 0.000 0.000 0.000 N\n")

    async def test_hapticctl_moves_it_over_a_time(self) -> None:
        daemon = await self.connect()
        await daemon.move_device("mouse", (0.0, 0.1, 0.0))
        await asyncio.sleep(0.15)  # until another client may
        process = await asyncio.create_subprocess_exec(
            HAPTICCTL, "--socket", str(self.socket), "device", "move", "mouse", "--at", "0.2", "0.1", "0",
            "--over", "0.4", stdout=subprocess.PIPE)
        seen = set()
        while process.returncode is None:
            seen.add((await daemon.devices())[1].pose.position.x)
            await asyncio.sleep(0.01)
        await process.wait()
        self.assertEqual((await daemon.devices())[1].pose.position.x, 0.2)
        self.assertTrue(any(0.0 < x < 0.2 for x in seen), seen)


class Stale(VirtualTest):
    safety = "safety { max_sample_age: 0.3 max_force_rate: 1e6 max_speed: 100 arm_ramp: 0.001 }"

    async def test_who_no_longer_tells_where_it_is_loses_it_and_its_fault_is_named(self) -> None:
        daemon = await self.connect()
        await self.press(daemon)
        async with asyncio.timeout(PATIENCE):
            while not (status := await daemon.status()).fault:
                await asyncio.sleep(0.01)
        self.assertEqual([(one.kind, one.device) for one in status.fault], [(haptic.FaultKind.STALE_SAMPLE, "mouse")])
        self.assertGreater(status.fault[0].value, 0.3)
        self.assertFalse(status.armed)
        (record,) = await daemon.faults()
        self.assertEqual((record.fault, record.latched, record.recording), (status.fault[0], True, ""))
        # telling it again does not bring the force back
        force = await daemon.move_device("mouse", INSIDE)
        self.assertEqual(force.wrench.force.y, 0.0)


class Life(DaemonTest):
    def make_listen(self) -> str:
        # a port that no machine has: whatever is plugged in, this device is absent
        return super().make_listen() + ' device { name: "head" fastrak { port: "/dev/no-such-port" } }'

    async def test_the_daemon_starts_without_its_hardware_and_tells_why_it_is_not_there(self) -> None:
        daemon = await self.connect()
        async with asyncio.timeout(PATIENCE):
            while "no such port" not in (head := (await daemon.devices())[1]).reason:
                await asyncio.sleep(0.01)
        self.assertEqual(head.phase, haptic.DevicePhase.ABSENT)
        self.assertEqual((head.serial, head.losses, head.present), ("", 0, False))

    async def test_frames_tell_phases(self) -> None:
        daemon = await self.connect()
        await daemon.arm()
        async with daemon.subscribe([haptic.Topic.DEVICES]) as frames:
            async for frame in frames:
                assert frame.devices is not None
                phases = list(frame.devices.phase)
                if phases == [haptic.DevicePhase.ARMED, haptic.DevicePhase.ABSENT]:
                    break

    async def test_it_is_managed_by_name(self) -> None:
        daemon = await self.connect()
        await daemon.manage_device("head", haptic.DeviceAction.REOPEN)
        with self.assertRaises(haptic.Unsupported):
            await daemon.manage_device("head", haptic.DeviceAction.HOME)
        with self.assertRaises(haptic.Unsupported):
            await daemon.manage_device("probe", haptic.DeviceAction.REOPEN)
        with self.assertRaises(haptic.NotFound):
            await daemon.manage_device("nobody", haptic.DeviceAction.REOPEN)


if __name__ == "__main__":
    unittest.main()
