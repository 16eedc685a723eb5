"""What a machine and its users do to a daemon: each time the daemon is afterwards what it was before, or tells why not.

HAPTICD and HAPTICCTL name the programs.
"""

from __future__ import annotations

import asyncio
import os
import resource
import signal
import socket
import subprocess
import unittest
from pathlib import Path

import haptic
from haptic import v1
from support import HAPTICCTL, HAPTICD, PATIENCE, DaemonTest

SOON = 0.01  # s
FAKE_TIME = Path("/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1")


class AdversityTest(DaemonTest):
    def make_listen(self) -> str:
        # the hand of these tests does not mind a slow machine
        return super().make_listen() + (
            "safety { max_sample_age: 5 max_missed_ticks: 100 arm_ramp: 0.001 max_arm_force: 5 }")

    def limit(self, what: int, value: int) -> None:
        hard = resource.prlimit(self.daemon.pid, what)[1]
        resource.prlimit(self.daemon.pid, what, (value, hard))

    def log_text(self) -> str:
        return self.log.read_text()

    async def expect_ticks(self, daemon: haptic.Connection, count: int = 100) -> None:
        """Frames of ticks that ascend, each of them or told as lost."""
        async with asyncio.timeout(PATIENCE):
            async with daemon.subscribe([haptic.Topic.HIPS]) as frames:
                last = -1
                async for one in frames:
                    self.assertGreater(one.tick, last)
                    last = one.tick
                    count -= 1
                    if count == 0:
                        return

    async def expect_service(self) -> None:
        """A new client is served."""
        async with asyncio.timeout(PATIENCE):
            while True:
                try:
                    async with haptic.connect(self.socket, timeout=PATIENCE) as daemon:
                        await self.expect_ticks(daemon, 10)
                        return
                except haptic.Error:
                    await asyncio.sleep(SOON)

    async def press(self) -> haptic.Connection:
        """Armed, in contact, with the force of 1 N on the device."""
        daemon = await self.connect()
        await daemon.arm()
        await self.wait_for_force(daemon, 1.0)
        return daemon

    async def wait_for_force(self, daemon: haptic.Connection, force: float) -> None:
        async with asyncio.timeout(PATIENCE):
            while abs((await daemon.devices())[0].wrench.force.y - force) > 1e-9:
                await asyncio.sleep(SOON)

    async def wait_for_fault(self, daemon: haptic.Connection, kind: v1.FaultKind.ValueType) -> None:
        async with asyncio.timeout(PATIENCE):
            while kind not in [fault.kind for fault in (await daemon.status()).fault]:
                await asyncio.sleep(SOON)
        self.assertFalse((await daemon.status()).armed)
        await self.wait_for_force(daemon, 0.0)


class Descriptors(AdversityTest):
    async def test_when_they_have_run_out_those_who_are_in_are_served_on(self) -> None:
        inside = await self.connect()
        in_use = len(os.listdir(f"/proc/{self.daemon.pid}/fd"))
        self.limit(resource.RLIMIT_NOFILE, in_use + 3)
        crowd = []
        for _ in range(20):
            crowd.append(socket.socket(socket.AF_UNIX))
            crowd[-1].connect(str(self.socket))
        await self.expect_ticks(inside, 300)
        self.assertIn("cannot accept a client", self.log_text())
        self.assertLess(self.log_text().count("cannot accept a client"), 20)
        for one in crowd:
            one.close()
        await self.expect_service()


class Crowd(AdversityTest):
    async def test_whoever_is_too_many_is_told_and_the_others_notice_nothing(self) -> None:
        inside = await self.connect()
        crowd = [asyncio.create_task(self.come_and_stay()) for _ in range(200)]
        try:
            await self.expect_ticks(inside, 300)
        finally:
            for one in crowd:
                one.cancel()
        told = [one for one in await asyncio.gather(*crowd, return_exceptions=True) if isinstance(one, haptic.Error)]
        self.assertGreater(len(told), 100)
        self.assertEqual([str(one) for one in told if "no more are taken" not in str(one)], [])
        await self.expect_service()

    async def come_and_stay(self) -> None:
        async with haptic.connect(self.socket, timeout=PATIENCE) as daemon:
            async with daemon.subscribe([haptic.Topic.HIPS]) as frames:
                async for _ in frames:
                    pass

    async def test_a_storm_of_processes_is_served_or_refused(self) -> None:
        inside = await self.connect()
        storm = [await asyncio.create_subprocess_exec(
            HAPTICCTL, "--socket", str(self.socket), "status",
            stdout=asyncio.subprocess.DEVNULL, stderr=asyncio.subprocess.DEVNULL) for _ in range(40)]
        await self.expect_ticks(inside)
        codes = {await one.wait() for one in storm}
        self.assertLessEqual(codes, {0, 1, 5})
        self.assertIn(0, codes)


class Socket(AdversityTest):
    async def test_is_deleted_and_those_who_are_in_are_served_on(self) -> None:
        inside = await self.connect()
        self.socket.unlink()
        await self.expect_ticks(inside)
        with self.assertRaises(haptic.Unreachable):
            await haptic.connect(self.socket, timeout=PATIENCE)
        self.stop()
        self.assertEqual(self.daemon.returncode, 0, self.log_text())
        self.start()
        await self.expect_service()

    async def test_another_file_in_its_place_is_not_taken_away_at_the_end(self) -> None:
        self.socket.unlink()
        self.socket.write_text("mine")
        self.stop()
        self.assertEqual(self.socket.read_text(), "mine")


class Signals(AdversityTest):
    async def test_a_daemon_that_was_stopped_and_goes_on_pushes_nobody(self) -> None:
        daemon = await self.press()
        self.daemon.send_signal(signal.SIGSTOP)
        await asyncio.sleep(0.3)
        self.daemon.send_signal(signal.SIGCONT)
        await self.wait_for_fault(daemon, v1.FAULT_MISSED_TICKS)
        await daemon.clear_fault()
        await daemon.arm()
        await self.wait_for_force(daemon, 1.0)


class Drivers(AdversityTest):
    """Clients of each kind, killed while they drive."""

    async def expect_lost(self, driver: asyncio.subprocess.Process) -> None:
        daemon = await self.connect()
        async with asyncio.timeout(PATIENCE):
            status = await daemon.status()
            while not (status.armed and status.HasField("drive_holder")):
                self.assertIsNone(driver.returncode)
                await asyncio.sleep(SOON)
                status = await daemon.status()
        await self.wait_for_force(daemon, 1.0)
        driver.kill()
        await driver.wait()
        await self.wait_for_fault(daemon, v1.FAULT_LOST_DRIVER)
        await self.expect_service()

    async def spawn(self, *command: str) -> asyncio.subprocess.Process:
        return await asyncio.create_subprocess_exec(*command, stdin=asyncio.subprocess.DEVNULL,
                                                    stdout=asyncio.subprocess.DEVNULL)

    async def test_a_script(self) -> None:
        script = self.folder / "press.script"
        script.write_text("arm\nwait 3600s\n")
        await self.expect_lost(await self.spawn(HAPTICCTL, "--socket", str(self.socket), "run", str(script)))

    async def test_a_python_program(self) -> None:
        program = self.folder / "press.py"
        program.write_text(
            "import asyncio, sys, haptic\n"
            "async def press():\n"
            "    async with haptic.connect(sys.argv[1]) as daemon, daemon.drive():\n"
            "        await daemon.arm()\n"
            "        await asyncio.sleep(3600)\n"
            "asyncio.run(press())\n")
        await self.expect_lost(await self.spawn("/usr/bin/python3", "-B", str(program), str(self.socket)))


class Disk(AdversityTest):
    async def test_a_recording_that_finds_no_room_fails_alone(self) -> None:
        inside = await self.connect()

        def little_room() -> None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (65536, 65536))

        file = self.folder / "trial.mcap"
        done = await asyncio.to_thread(
            subprocess.run, [HAPTICCTL, "--socket", str(self.socket), "record", str(file), "--seconds", "60"],
            preexec_fn=little_room, capture_output=True, text=True, check=False, timeout=PATIENCE)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("File too large", done.stderr)
        await self.expect_ticks(inside)

    def test_a_table_that_finds_no_room_is_told(self) -> None:
        done = subprocess.run(
            [HAPTICD, "simulate", "--config", str(self.folder / "hapticd.txtpb"), "--duration", "1",
             "--hips-csv", "/dev/full"], capture_output=True, text=True, check=False, timeout=PATIENCE)
        self.assertEqual(done.returncode, 1)
        self.assertIn("No space left on device", done.stderr)


class Memory(AdversityTest):
    def used(self) -> int:
        """Address space, in bytes."""
        return int(Path(f"/proc/{self.daemon.pid}/statm").read_text().split()[0]) * resource.getpagesize()

    async def test_a_scene_that_is_too_large_fails_alone(self) -> None:
        daemon = await self.press()
        self.limit(resource.RLIMIT_AS, self.used() + 256 * 1024 * 1024)
        scene = v1.Scene(name="dust", material=[v1.Material(name="air", free={}),
                                                v1.Material(name="stone", density=2000, rigid={})])
        for i in range(60):
            ball = scene.object.add(name=f"ball{i}", inside="stone", outside="air", air_margin=0.01)
            ball.shape.icosphere.radius = 0.01
            ball.shape.icosphere.subdivisions = 6
            ball.pose.position.x = 0.1 * i
        with self.assertRaisesRegex(haptic.Error, "not enough memory"):
            await daemon.load_scene(scene)
        await self.wait_for_force(daemon, 1.0)
        await self.expect_service()

    async def test_when_it_has_run_out_the_daemon_ends_in_order_and_tells_why(self) -> None:
        await self.press()
        self.limit(resource.RLIMIT_AS, self.used() + 1024 * 1024)
        async with asyncio.timeout(PATIENCE):
            while self.daemon.poll() is None:
                # frames pile up for those who do not read them
                sloth = socket.socket(socket.AF_UNIX)
                self.addCleanup(sloth.close)
                try:
                    sloth.setblocking(False)
                    sloth.connect(str(self.socket))
                    sloth.sendall(self.subscription())
                except OSError:
                    pass  # it is full, or has just ended
                await asyncio.sleep(SOON)
        self.assertEqual(self.daemon.returncode, 1, self.log_text())
        self.assertIn("memory has run out; forces were let down first", self.log_text())

    @staticmethod
    def subscription() -> bytes:
        hello = v1.Envelope(hello=v1.Hello(major=1, program="sloth"))
        wish = v1.Subscribe(topic=[v1.HIPS, v1.DEVICES, v1.OBJECTS], delivery=v1.LOSSLESS)
        request = v1.Envelope(request=v1.Request(id=1, subscribe=wish))
        return b"".join(haptic.framing.frame(one.SerializeToString()) for one in (hello, request))


@unittest.skipUnless(FAKE_TIME.exists(), "there is no libfaketime")
class Clock(AdversityTest):
    def start(self) -> None:
        self.clock = self.folder / "clock"
        self.clock.write_text("+0")
        os.environ.update(LD_PRELOAD=str(FAKE_TIME), FAKETIME_TIMESTAMP_FILE=str(self.clock),
                          FAKETIME_DONT_FAKE_MONOTONIC="1", FAKETIME_NO_CACHE="1")
        try:
            super().start()
        finally:
            del os.environ["LD_PRELOAD"]

    async def offset(self, daemon: haptic.Connection) -> float:
        """Of the wall clock from the clock that is never set, in seconds, as frames tell it."""
        async with daemon.subscribe([haptic.Topic.HIPS]) as frames:
            async for one in frames:
                return (one.realtime_ns - one.monotonic_ns) * 1e-9
        raise AssertionError("no frame came")

    async def test_is_set_and_no_tick_notices(self) -> None:
        daemon = await self.press()
        before = await self.offset(daemon)
        for step in (3600.0, -3600.0):
            self.clock.write_text(f"{step:+.0f}")
            self.assertAlmostEqual(await self.offset(daemon) - before, step, delta=PATIENCE)
            await self.expect_ticks(daemon, 300)
        status = await daemon.status()
        self.assertTrue(status.armed)
        self.assertEqual(list(status.fault), [])


if __name__ == "__main__":
    unittest.main()
