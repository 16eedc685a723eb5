"""The drive lease with its heartbeats, and TLS."""

import asyncio
import re
import socket
import subprocess
import time
import unittest

import haptic
from haptic import v1
from support import HAPTICCTL, PATIENCE, DaemonTest, FakeDaemon, FakeDaemonTest


class Drive(DaemonTest):
    heartbeat = 1.0

    async def test_nobody_else_arms_while_the_lease_is_held(self) -> None:
        daemon, other = await self.connect(), await self.connect()
        async with daemon.drive() as lease:
            self.assertEqual(lease.silence, 1.0)
            with self.assertRaisesRegex(haptic.Refused, "holds the drive lease"):
                await other.arm()
            with self.assertRaises(haptic.Refused):
                async with other.drive():
                    self.fail("two held the lease")
            await daemon.arm()
        await other.arm()

    async def test_anybody_stops_in_an_emergency_while_the_lease_is_held(self) -> None:
        daemon = await self.connect()
        other = await self.connect()
        async with daemon.drive(keep_armed=True):
            await daemon.arm()
            await other.emergency_stop()
            status = await daemon.status()
            self.assertFalse(status.armed)
            self.assertEqual([one.kind for one in status.fault], [haptic.FaultKind.EMERGENCY_STOP])
            with self.assertRaises(haptic.FaultLatched):
                await daemon.arm()

    async def test_heartbeats_keep_the_lease(self) -> None:
        daemon = await self.connect()
        async with daemon.drive():
            await daemon.arm()
            await asyncio.sleep(1.5 * self.heartbeat)
            status = await daemon.status()
        self.assertTrue(status.armed)
        self.assertEqual(len(status.fault), 0)

    async def test_the_block_disarms_when_it_ends(self) -> None:
        daemon = await self.connect()
        async with daemon.drive():
            await daemon.arm()
        self.assertFalse((await daemon.status()).armed)
        with self.assertRaises(ZeroDivisionError):
            async with daemon.drive(keep_armed=True):
                await daemon.arm()
                1 / 0
        self.assertFalse((await daemon.status()).armed)
        async with daemon.drive(keep_armed=True):
            await daemon.arm()
        self.assertTrue((await daemon.status()).armed)

    async def test_a_silence_that_the_config_does_not_permit_is_refused(self) -> None:
        daemon = await self.connect()
        with self.assertRaisesRegex(haptic.Invalid, "acquire_drive.heartbeat_ms"):
            async with daemon.drive(silence=10):
                self.fail("it was permitted")

    async def test_who_keeps_the_loop_from_running_loses_the_lease(self) -> None:
        daemon = await self.connect()
        with self.assertRaisesRegex(haptic.NotFound, "do not hold the drive lease"):
            async with daemon.drive(silence=0.05):
                await daemon.arm()
                time.sleep(1)
                await asyncio.sleep(PATIENCE)
        status = await daemon.status()
        self.assertEqual([one.kind for one in status.fault], [haptic.FaultKind.LOST_DRIVER])
        self.assertFalse(status.armed)
        with self.assertRaises(haptic.FaultLatched):
            await daemon.arm()
        await daemon.clear_fault()
        # nothing is left of the cancelling
        self.assertEqual(getattr(asyncio.current_task(), "cancelling")(), 0)

    async def test_a_driver_that_is_cancelled_gives_the_lease_back(self) -> None:
        daemon, other = await self.connect(), await self.connect()
        driving = asyncio.Event()

        async def drive() -> None:
            async with daemon.drive():
                await daemon.arm()
                driving.set()
                await asyncio.sleep(PATIENCE)

        task = asyncio.create_task(drive())
        await driving.wait()
        task.cancel()
        with self.assertRaises(asyncio.CancelledError):
            await task
        status = await daemon.status()
        self.assertEqual((status.armed, len(status.fault)), (False, 0))
        await other.arm()


class LostDrive(FakeDaemonTest):
    async def test_a_daemon_that_goes_away_ends_the_block(self) -> None:
        async def talk(fake: FakeDaemon) -> None:
            request = (await fake.receive()).request
            fake.send(v1.Envelope(response=v1.Response(id=request.id, drive_lease=v1.DriveLease(heartbeat_ms=20))))
            self.assertTrue((await fake.receive()).request.HasField("heartbeat"))

        daemon = await self.connect(talk)
        with self.assertRaises(haptic.Unreachable):
            async with daemon.drive():
                await asyncio.sleep(PATIENCE)


class Tls(DaemonTest):
    """With the certificates of one laboratory, and of another."""

    def make_listen(self) -> str:
        lab = self.folder / "lab"
        subprocess.run(
            [HAPTICCTL, "certificates", str(lab), "--server-name", "localhost", "--client", "alice", "--client", "bob"],
            check=True, capture_output=True)
        subprocess.run(
            [HAPTICCTL, "certificates", str(self.folder / "elsewhere"), "--server-name", "localhost", "--client",
             "alice"], check=True, capture_output=True)
        self.port = free_port()
        return super().make_listen() + f"""
            listen {{ tcp {{ address: "127.0.0.1" port: {self.port}
              tls {{ certificate: "lab/server.crt" key: "lab/server.key" authority: "lab/authority.crt" }}
              allow {{ name: "alice" role: SCRIPT }} }} }}"""

    def identity(self, name: str, folder: str = "lab", authority: str = "lab") -> haptic.Identity:
        return haptic.Identity(*(str(self.folder / file) for file in (
            f"{folder}/{name}.crt", f"{folder}/{name}.key", f"{authority}/authority.crt")))

    async def test_a_certificate_gives_its_role(self) -> None:
        alice = self.identity("alice")
        async with haptic.connect(f"localhost:{self.port}", identity=alice, timeout=PATIENCE) as daemon:
            self.assertEqual(daemon.role, haptic.Role.SCRIPT)
            self.assertEqual((await daemon.status()).scene, "press")
            with self.assertRaises(haptic.Refused):
                await daemon.arm()

    async def test_a_name_that_is_not_allowed_is_refused(self) -> None:
        with self.assertRaises(haptic.Refused):
            await haptic.connect(f"localhost:{self.port}", identity=self.identity("bob"), timeout=PATIENCE)

    async def test_a_certificate_of_another_authority_is_not_taken(self) -> None:
        with self.assertRaisesRegex(haptic.Unreachable, "closed the connection"):
            await haptic.connect(f"localhost:{self.port}", identity=self.identity("alice", "elsewhere"))

    async def test_a_server_of_another_authority_is_not_believed(self) -> None:
        with self.assertRaisesRegex(haptic.Unreachable, "cannot be trusted"):
            await haptic.connect(f"localhost:{self.port}", identity=self.identity("alice", authority="elsewhere"))

    async def test_a_server_by_another_name_is_not_believed(self) -> None:
        with self.assertRaisesRegex(haptic.Unreachable, "127.0.0.1"):
            await haptic.connect(f"127.0.0.1:{self.port}", identity=self.identity("alice"))

    async def test_files_that_cannot_be_used_are_told(self) -> None:
        with self.assertRaisesRegex(haptic.Invalid, "the key is missing"):
            await haptic.connect("localhost:1", identity=haptic.Identity(str(self.log), "", str(self.log)))
        with self.assertRaisesRegex(haptic.Invalid, "cannot read /nowhere, the key"):
            await haptic.connect("localhost:1", identity=haptic.Identity(str(self.log), "/nowhere", str(self.log)))
        with self.assertRaisesRegex(haptic.Invalid, re.escape(str(self.log))):
            await haptic.connect("localhost:1", identity=haptic.Identity(*3 * [str(self.log)]))


def free_port() -> int:
    """A port that nobody listens at."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port: int = one.getsockname()[1]
    return port


if __name__ == "__main__":
    unittest.main()
