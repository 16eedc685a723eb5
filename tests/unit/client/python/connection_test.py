"""Connecting and calling, against a real hapticd."""

import asyncio
import os
import socket
import unittest
from unittest import mock

import haptic
from haptic import edits, v1
from haptic.address import Identity, find_address, parse_address
from haptic.transport import open_streams
from support import HAPTICCTL, PATIENCE, SCENE, DaemonTest, FakeDaemon, FakeDaemonTest


class Addresses(unittest.TestCase):
    def test_what_has_a_slash_or_no_colon_is_a_path(self) -> None:
        self.assertEqual(parse_address("/run/a:1"), haptic.Address(path="/run/a:1"))
        self.assertEqual(parse_address("a.sock"), haptic.Address(path="a.sock"))
        self.assertEqual(parse_address("lab.example:7411"), haptic.Address(host="lab.example", port="7411"))
        self.assertEqual(parse_address("[::1]:7411"), haptic.Address(host="::1", port="7411"))
        self.assertEqual(str(parse_address("[::1]:7411")), "[::1]:7411")

    def test_the_environment_is_asked_in_the_order_of_hapticctl(self) -> None:
        found = {"HAPTICD_SERVER": "lab:1", "HAPTICD_SOCKET": "/a.sock", "XDG_RUNTIME_DIR": "/run/user/1"}
        with mock.patch("haptic.address.SERVICE_SOCKET", "/nowhere/hapticd.sock"):
            for expected in ("lab:1", "/a.sock", "/run/user/1/hapticd/hapticd.sock",
                             f"/tmp/hapticd-{os.getuid()}/hapticd.sock"):
                with mock.patch.dict(os.environ, found, clear=True):
                    self.assertEqual(str(find_address()), expected)
                    self.assertEqual(str(find_address("/given")), "/given")
                found.pop(next(iter(found), ""), None)
        with mock.patch("haptic.address.SERVICE_SOCKET", "/etc/hostname"), mock.patch.dict(os.environ, {}, clear=True):
            self.assertEqual(str(find_address()), "/etc/hostname")

    def test_a_server_without_a_port_is_refused(self) -> None:
        with mock.patch.dict(os.environ, {"HAPTICD_SERVER": "lab"}):
            with self.assertRaisesRegex(haptic.Invalid, '"lab" is no server; host:port is expected'):
                find_address()


class Calls(DaemonTest):
    async def test_hello_tells_the_version_and_the_role(self) -> None:
        daemon = await self.connect()
        self.assertEqual(daemon.hello.version, haptic.__version__)
        self.assertEqual(daemon.role, haptic.Role.ADMIN)

    async def test_status_devices_and_scene_are_those_of_the_config(self) -> None:
        daemon = await self.connect()
        status = await daemon.status()
        self.assertEqual((status.scene, status.rate_hz, status.hips, status.armed), ("press", 1000.0, 1, False))
        devices = await daemon.devices()
        self.assertEqual([one.description.name for one in devices], ["probe"])
        scene = await daemon.scene()
        self.assertEqual(haptic.hips_of(scene, "thumb"), slice(0, 1))
        self.assertEqual(haptic.object_index(scene, "cube"), 0)
        with self.assertRaises(haptic.NotFound):
            haptic.hips_of(scene, "toe")

    async def test_steps_run_exactly_as_many_ticks_of_the_scene(self) -> None:
        daemon = await self.connect()
        await daemon.pause()
        # an object that falls without resistance has the speed g n dt after n ticks
        scene = haptic.read_scene(self.folder / "press.scene.txtpb")
        scene.object[0].dynamic.release_after = 0.0
        scene.gravity.y = -10.0
        scene.object[0].pose.position.x = 1.0  # away from the finger
        await daemon.load_scene(scene)
        speeds = []
        for ticks in (1, 50):
            await daemon.step(ticks)
            async with daemon.subscribe([haptic.Topic.OBJECTS]) as frames:
                frame = await frames.next(PATIENCE)
            assert frame.objects
            self.assertTrue(frame.paused)
            speeds.append(frame.objects.velocity[0, 1])
        self.assertAlmostEqual(speeds[1] - speeds[0], -10.0 * 50 * 0.001, places=12)
        with self.assertRaises(haptic.NothingToDo):
            await daemon.pause()
        await daemon.resume()
        with self.assertRaisesRegex(haptic.NothingToDo, "not paused"):
            await daemon.step()

    async def test_errors_have_the_type_of_what_is_wrong(self) -> None:
        daemon = await self.connect()
        with self.assertRaises(haptic.NothingToDo):
            await daemon.disarm()
        with self.assertRaises(haptic.NothingToDo):
            await daemon.clear_fault()
        with self.assertRaisesRegex(haptic.NotFound, "toe"):
            await daemon.subscribe([haptic.Topic.HIPS], fingers=["toe"])
        with self.assertRaises(haptic.Invalid):
            await daemon.subscribe([])
        with self.assertRaises(haptic.Error):
            await daemon.call(v1.Request())
        self.assertEqual((await daemon.status()).scene, "press")

    async def test_a_scene_is_sent_from_here(self) -> None:
        daemon = await self.connect()
        scene = haptic.read_scene(self.folder / "press.scene.txtpb")
        scene.name = "another"
        scene.object[0].shape.box.size.x = 0.1
        told = await daemon.load_scene(scene)
        self.assertEqual((told.scene.name, told.object[0].name), ("another", "cube"))
        self.assertEqual((await daemon.scene()).scene, told.scene)

    async def test_a_scene_is_read_by_the_daemon(self) -> None:
        daemon = await self.connect()
        file = self.folder / "wrong.scene.txtpb"
        file.write_text(SCENE.replace("0.04 y", "-1 y"))
        with self.assertRaises(haptic.Invalid) as caught:
            await daemon.load_scene_file(file)
        self.assertEqual((caught.exception.wire.file, caught.exception.wire.line), (str(file), 6))
        self.assertIn("object[0].shape.box.size", caught.exception.wire.field)
        told = await daemon.load_scene_file(self.folder / "press.scene.txtpb")
        self.assertEqual(told.scene.name, "press")

    async def test_edits_change_the_scene_all_or_none(self) -> None:
        daemon = await self.connect()
        ice = v1.Material(name="ice", density=900, rigid=v1.Material.Rigid())
        before = await daemon.scene()
        await daemon.edit(
            edits.add_material(ice),
            edits.set_object(v1.Object(name="cube", inside="ice"), ["inside"]),
            edits.remove_material("wood"),
            edits.set_gravity((0, -9.81, 0)),
            edits.move_object("cube", position=(0.5, 0, 0)),
            expected_revision=before.revision,
        )
        after = (await daemon.scene()).scene
        self.assertEqual([one.name for one in after.material], ["air", "ice"])
        self.assertEqual((after.object[0].inside, after.gravity.y), ("ice", -9.81))
        with self.assertRaisesRegex(haptic.Invalid, r"edit\[1\].remove_object: there is no object"):
            await daemon.edit(edits.set_gravity((0, 0, 0)), edits.remove_object("sphere"))
        self.assertEqual((await daemon.scene()).scene.gravity.y, -9.81)
        with self.assertRaises(haptic.Error):
            await daemon.edit(edits.set_gravity((0, 0, 0)), expected_revision=before.revision)

    async def test_many_tasks_call_at_once_and_each_gets_its_own_answer(self) -> None:
        daemon = await self.connect()
        answers = await asyncio.gather(*(daemon.call(request) for request in 10 * [
            v1.Request(get_status=v1.GetStatus()), v1.Request(get_scene=v1.GetScene())]))
        self.assertEqual([one.WhichOneof("result") for one in answers], 10 * ["status", "scene"])

    async def test_events_reach_whoever_listens(self) -> None:
        daemon, other = await self.connect(), await self.connect()
        events = other.events()
        await daemon.arm()
        async with asyncio.timeout(PATIENCE):
            kinds = [(await anext(events)).kind]
            await daemon.disarm()
            kinds.append((await anext(events)).kind)
        self.assertEqual(kinds, [haptic.EventKind.ARMED, haptic.EventKind.DISARMED])

    async def test_a_daemon_that_ends_is_unreachable_for_all_who_wait(self) -> None:
        daemon = await self.connect()
        frames = await daemon.subscribe([haptic.Topic.EVENTS])
        events = daemon.events()
        await asyncio.to_thread(self.stop)
        async with asyncio.timeout(PATIENCE):
            with self.assertRaises(haptic.Unreachable):
                await frames.next()
            self.assertEqual([one async for one in events], [])
        with self.assertRaises(haptic.Unreachable):
            await daemon.status()
        with self.assertRaisesRegex(haptic.Unreachable, "is hapticd running"):
            await haptic.connect(self.socket)

    async def test_a_connection_that_was_closed_takes_no_calls(self) -> None:
        daemon = await self.connect()
        await daemon.close()
        await daemon.close()
        with self.assertRaises(haptic.Unreachable):
            await daemon.status()

    async def test_a_script_of_hapticctl_runs_beside_the_program(self) -> None:
        daemon = await self.connect()
        script = "echo scene $name\npause\nstep 3\n"
        output = await haptic.run_script(
            text=script, variables={"name": "press"}, address=self.socket, hapticctl=HAPTICCTL)
        self.assertIn("scene press", output)
        self.assertTrue((await daemon.status()).paused)

    async def test_a_script_that_fails_raises_what_its_line_raised(self) -> None:
        with self.assertRaisesRegex(haptic.NotFound, "toe"):
            await haptic.run_script(text="watch --finger toe\n", address=self.socket, hapticctl=HAPTICCTL)
        with self.assertRaises(haptic.Invalid):
            await haptic.run_script(text="dance\n", address=self.socket, hapticctl=HAPTICCTL)
        with self.assertRaisesRegex(haptic.Error, "cannot run /nowhere/hapticctl"):
            await haptic.run_script(text="", hapticctl="/nowhere/hapticctl")


class SceneFiles(DaemonTest):
    async def test_a_scene_comes_back_from_a_file(self) -> None:
        daemon = await self.connect()
        scene = (await daemon.scene()).scene
        for name in ("copy.scene.txtpb", "copy.scene.json"):
            haptic.write_scene(scene, self.folder / name)
            self.assertEqual(haptic.read_scene(self.folder / name), scene)
            self.assertEqual((await daemon.load_scene_file(self.folder / name)).scene, scene)

    async def test_what_is_no_scene_is_told_with_its_place(self) -> None:
        file = self.folder / "wrong.scene.txtpb"
        file.write_text('name: "wrong"\nobjekt {}\n')
        with self.assertRaises(haptic.Invalid) as caught:
            haptic.read_scene(file)
        self.assertRegex(str(caught.exception), rf"^{file}:2:1: .*objekt")
        file.write_bytes(b'name: "\xff"')
        with self.assertRaisesRegex(haptic.Invalid, "not UTF-8 at byte 7"):
            haptic.read_scene(file)
        (self.folder / "wrong.json").write_text('{"name": 1')
        with self.assertRaisesRegex(haptic.Invalid, "wrong.json"):
            haptic.read_scene(self.folder / "wrong.json")
        with self.assertRaises(haptic.NotFound):
            haptic.read_scene(self.folder / "missing.scene.txtpb")


class OddDaemons(FakeDaemonTest):
    async def test_another_major_is_a_mismatch_in_words(self) -> None:
        with self.assertRaisesRegex(haptic.ProtocolMismatch, "speaks protocol 1.0, the daemon .old 7. 2.5"):
            await self.connect(FakeDaemon.wait_until_gone, v1.Hello(major=2, minor=5, program="old", version="7"))

    async def test_a_goodbye_tells_why(self) -> None:
        async def talk(fake: FakeDaemon) -> None:
            await fake.receive()
            refused = v1.Error(code=v1.Error.REFUSED, message="too many clients")
            fake.send(v1.Envelope(goodbye=v1.Goodbye(error=refused)))

        daemon = await self.connect(talk)
        with self.assertRaisesRegex(haptic.Refused, "too many clients"):
            await daemon.status()

    async def test_what_cannot_be_read_is_no_daemon(self) -> None:
        for garbage in (b"\xff\xff\xff\xff\x7f", b"\x80\x00", b"\x02\xff\xff"):
            async def talk(fake: FakeDaemon) -> None:
                await fake.receive()
                fake.writer.write(garbage)
                await fake.wait_until_gone()

            with self.subTest(garbage):
                daemon = await self.connect(talk)
                with self.assertRaisesRegex(haptic.Unreachable, "is not a hapticd"):
                    await daemon.status()
                await daemon.close()
                (self.folder / "fake.sock").unlink()

    async def test_an_answer_that_does_not_come_ends_the_waiting_alone(self) -> None:
        async def talk(fake: FakeDaemon) -> None:
            late, now = (await fake.receive()).request, (await fake.receive()).request
            for request in (late, now):
                fake.send(v1.Envelope(response=v1.Response(id=request.id, status=v1.Status(tick=request.id))))
            await fake.wait_until_gone()

        daemon = await self.connect(talk)
        request = v1.Request(get_status=v1.GetStatus())
        with self.assertRaisesRegex(haptic.Unreachable, "did not answer within 0.01 s"):
            await daemon.call(request, timeout=0.01)
        self.assertEqual((await daemon.status()).tick, 2)

    async def test_who_says_nothing_is_not_waited_for_longer_than_asked(self) -> None:
        server = await asyncio.start_unix_server(lambda reader, writer: None, self.folder / "mute.sock")
        async with server:
            with self.assertRaisesRegex(haptic.Unreachable, "did not say hello within 0.05 s"):
                await haptic.connect(self.folder / "mute.sock", timeout=0.05)

    async def test_a_queue_that_is_full_is_waited_for(self) -> None:
        with socket.socket(socket.AF_UNIX) as listener, socket.socket(socket.AF_UNIX) as first:
            listener.bind(str(self.folder / "full.sock"))
            listener.listen(0)  # one may wait
            first.connect(str(self.folder / "full.sock"))
            second = asyncio.create_task(open_streams(haptic.Address(path=str(self.folder / "full.sock")), Identity()))
            done, _ = await asyncio.wait([second], timeout=0.05)
            self.assertEqual(done, set())
            listener.accept()[0].close()
            async with asyncio.timeout(PATIENCE):
                _, writer = await second
            writer.write(b"in")
            with listener.accept()[0] as accepted:
                self.assertEqual(accepted.recv(2), b"in")
            writer.close()

    async def test_messages_of_a_newer_daemon_are_skipped(self) -> None:
        async def talk(fake: FakeDaemon) -> None:
            request = (await fake.receive()).request
            fake.writer.write(b"\x05\xa2\x06\x02hi")  # field 100 of the envelope
            fake.send(v1.Envelope(response=v1.Response(id=request.id, status=v1.Status(tick=5))))
            await fake.wait_until_gone()

        daemon = await self.connect(talk)
        self.assertEqual((await daemon.status()).tick, 5)


if __name__ == "__main__":
    unittest.main()
