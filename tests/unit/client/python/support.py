"""A real hapticd for a test, in a folder of its own; and a daemon that says what a test wants it to say.

HAPTICD and HAPTICCTL name the programs.
"""

from __future__ import annotations

import asyncio
import os
import subprocess
import tempfile
import unittest
from collections.abc import Awaitable, Callable
from pathlib import Path

import haptic
from haptic import v1
from haptic.framing import FrameReader, frame

ROOT = Path(__file__).resolve().parents[4]
HAPTICD = os.environ["HAPTICD"]
HAPTICCTL = os.environ["HAPTICCTL"]
PATIENCE = 60.0  # s, for what takes no time on a machine that has nothing else to do

# One HIP on a device that comes down from 30 mm and stays at 10 mm, over a fixed cube of 40 mm that is never entered.
# So in the end the proxy is 20 mm high, straight above, and the force is 100 N/m * 10 mm = 1 N upwards.
CONFIG = """
device {{ name: "probe" playback {{ path: "path.csv" }} }}
scene: "press.scene.txtpb"
drive {{ heartbeat: {heartbeat} on_loss: FAULT }}
{listen}
"""
PATH = "time,x,y,z\n0,0.001,0.03,0.002\n0.05,0.001,0.01,0.002\n"
SCENE = """
name: "press"
material { name: "air" free {} }
material { name: "wood" density: 500 rigid { static_friction: 1 kinetic_friction: 0.5 } }
object {
  name: "cube" shape { box { size { x: 0.04 y: 0.04 z: 0.04 } } } inside: "wood" outside: "air" air_margin: 0.02
}
finger { name: "thumb" device: "probe" stiffness: 100 point {} }
"""


class DaemonTest(unittest.IsolatedAsyncioTestCase):
    """Each test has a hapticd of its own, which presses as told above."""

    listen = ""
    heartbeat = 10.0  # s

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.socket = self.folder / "hapticd.sock"
        self.log = self.folder / "log"
        (self.folder / "hapticd.txtpb").write_text(CONFIG.format(heartbeat=self.heartbeat, listen=self.make_listen()))
        (self.folder / "path.csv").write_text(PATH)
        (self.folder / "press.scene.txtpb").write_text(SCENE)
        self.start()

    def make_listen(self) -> str:
        """Where to listen beside the socket, as the config says it."""
        return f'listen {{ unix {{ path: "{self.socket}" }} }}' + self.listen

    def start(self) -> None:
        with self.log.open("wb") as log:
            self.daemon = subprocess.Popen(
                [HAPTICD, "run", "--config", str(self.folder / "hapticd.txtpb")],
                stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        self.addCleanup(self.stop)

    def stop(self) -> None:
        self.daemon.terminate()
        self.daemon.wait()

    async def asyncSetUp(self) -> None:
        async with asyncio.timeout(PATIENCE):
            while True:
                try:
                    async with haptic.connect(self.socket, timeout=PATIENCE):
                        return
                except haptic.Unreachable:
                    self.assertIsNone(self.daemon.poll(), self.log.read_text())
                    await asyncio.sleep(0.01)

    async def connect(self) -> haptic.Connection:
        """A connection that is closed when the test is over."""
        daemon = await haptic.connect(self.socket, program="test", timeout=PATIENCE)
        self.addAsyncCleanup(daemon.close)
        return daemon

    async def pressed(self) -> haptic.Connection:
        """The same when the HIP has come to rest in the cube, and the scene is paused."""
        daemon = await self.connect()
        async with daemon.subscribe([haptic.Topic.HIPS]) as frames:
            async with asyncio.timeout(PATIENCE):
                async for one in frames:
                    if one.hips is not None and one.hips.position[0, 1] == 0.01:
                        break
        await daemon.pause()
        await daemon.step(10)
        return daemon


Talk = Callable[["FakeDaemon"], Awaitable[None]]


class FakeDaemon:
    """Says hello to one client, then what `talk` says; ends the connection when that returns."""

    def __init__(self, folder: Path, talk: Talk, hello: v1.Hello | None = None) -> None:
        self.socket = folder / "fake.sock"
        self._talk = talk
        self._hello = hello or v1.Hello(major=1, program="fake", role=v1.ADMIN)
        self._frames = FrameReader(1024 * 1024)

    async def __aenter__(self) -> FakeDaemon:
        self._server = await asyncio.start_unix_server(self._serve, self.socket)
        return self

    async def __aexit__(self, *ignored: object) -> None:
        self._server.close()
        await self._server.wait_closed()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self.writer = reader, writer
        try:
            await self.receive()
            self.send(v1.Envelope(hello=self._hello))
            await self._talk(self)
        finally:
            writer.close()

    def send(self, *envelopes: v1.Envelope) -> None:
        """All in one piece."""
        self.writer.write(b"".join(frame(envelope.SerializeToString()) for envelope in envelopes))

    async def receive(self) -> v1.Envelope:
        while (message := self._frames.next()) is None:
            chunk = await self._reader.read(65536)
            if not chunk:
                raise ConnectionError("the client is gone")
            self._frames.append(chunk)
        envelope = v1.Envelope()
        envelope.ParseFromString(message)
        return envelope

    async def answer_subscribe(self, number: int, *more: v1.Envelope) -> None:
        """Takes a subscription; what follows goes in one piece with the answer."""
        request = (await self.receive()).request
        response = v1.Response(id=request.id, subscribed=v1.Subscribed(subscription=number))
        self.send(v1.Envelope(response=response), *more)

    async def wait_until_gone(self) -> None:
        """Until the client ends the connection."""
        try:
            while True:
                await self.receive()
        except ConnectionError:
            pass


class FakeDaemonTest(unittest.IsolatedAsyncioTestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    async def connect(self, talk: Talk, hello: v1.Hello | None = None) -> haptic.Connection:
        """A connection to a daemon that says this, until the test is over."""
        fake = FakeDaemon(self.folder, talk, hello)
        await self.enterAsyncContext(fake)
        daemon = await haptic.connect(fake.socket, timeout=PATIENCE)
        self.addAsyncCleanup(daemon.close)
        return daemon
