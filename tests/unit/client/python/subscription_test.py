"""Frames as arrays, against a real hapticd whose state is known; and what is lost, against one that loses at will."""

import asyncio
import unittest

import numpy as np

import haptic
from haptic import edits, v1
from haptic.frames import MalformedFrame, decode
from haptic.subscription import Inbox
from support import PATIENCE, DaemonTest, FakeDaemon, FakeDaemonTest

DEVICES, EVENTS, HIPS, OBJECTS, STATS = (
    haptic.Topic.DEVICES, haptic.Topic.EVENTS, haptic.Topic.HIPS, haptic.Topic.OBJECTS, haptic.Topic.STATS)


class Frames(DaemonTest):
    async def test_arrays_tell_where_everything_is(self) -> None:
        daemon = await self.pressed()
        async with daemon.subscribe([OBJECTS, HIPS, DEVICES]) as frames:
            frame = await frames.next(PATIENCE)
        hips, objects, devices = frame.hips, frame.objects, frame.devices
        assert hips and objects and devices
        self.assertTrue(frame.paused)
        self.assertFalse(frame.armed)
        np.testing.assert_array_equal(hips.position, [[0.001, 0.01, 0.002]])
        # straight above on the face at 20 mm, and 100 N/m of 10 mm: see support.py
        np.testing.assert_allclose(hips.contacts.proxy, [[0.001, 0.02, 0.002]], atol=1e-5)
        np.testing.assert_allclose(hips.force, [[0, 1, 0]], atol=1e-3)
        np.testing.assert_array_equal(hips.contacts.force, hips.force)
        np.testing.assert_array_equal(hips.contacts.hip, [0])
        np.testing.assert_array_equal(hips.contacts.object, [0])
        np.testing.assert_array_equal(hips.contacts.state, [haptic.State.SUR])
        np.testing.assert_array_equal(hips.contacts.slipping, [False])
        np.testing.assert_array_equal(objects.position, [[0, 0, 0]])
        np.testing.assert_array_equal(objects.orientation, [[1, 0, 0, 0]])
        np.testing.assert_array_equal(devices.position, [[0.001, 0.01, 0.002]])
        np.testing.assert_array_equal(devices.orientation, [[1, 0, 0, 0]])
        np.testing.assert_array_equal(devices.force, [[0, 0, 0]])
        np.testing.assert_array_equal(devices.present, [True])
        np.testing.assert_array_equal(devices.fault, [haptic.FaultKind.NONE])
        np.testing.assert_array_equal(devices.acceleration, [[0, 0, 0]])
        np.testing.assert_array_equal(devices.limits, [0])
        np.testing.assert_array_equal(devices.energy, [0])
        np.testing.assert_array_equal(hips.index, [0])
        self.assertIsNone(frame.stats)

    async def test_lossless_frames_come_in_sequence_or_a_gap_tells(self) -> None:
        daemon = await self.connect()
        async with daemon.subscribe([DEVICES]) as frames:
            taken = await frames.take(500, PATIENCE)
        # a machine with much else to do may lose some
        skipped = [one.gap.count if one.gap else 0 for one in taken]
        self.assertEqual([one.sequence for one in taken], list(np.arange(1, 501) + np.cumsum(skipped)))
        self.assertEqual(frames.lost, sum(skipped))
        self.assertTrue((np.diff([one.tick for one in taken]) >= 1).all())

    async def test_decimation_leaves_ticks_out(self) -> None:
        daemon = await self.connect()
        async with daemon.subscribe([DEVICES], decimation=20) as frames:
            ticks = np.array([one.tick for one in await frames.take(10, PATIENCE)])
        self.assertTrue((np.diff(ticks // 20) >= 1).all(), ticks)

    async def test_filters_select_and_the_index_tells_which(self) -> None:
        daemon = await self.pressed()
        await daemon.edit(
            edits.add_finger(v1.Finger(name="index", device="probe", stiffness=100, points=v1.Finger.Points(
                hip=[edits.vector((0.001, 1, 0)), edits.vector((0.002, 1, 0))]))),
            edits.add_object(v1.Object(name="far", inside="wood", pose=edits.pose((1, 0, 0)), shape=v1.Shape(
                box=v1.Shape.Box(size=edits.vector((0.1, 0.1, 0.1)))))))
        scene = await daemon.scene()
        self.assertEqual(haptic.hips_of(scene, "index"), slice(1, 3))
        await daemon.step(2)
        async with daemon.subscribe([HIPS, OBJECTS], fingers=["index"], objects=["far"]) as frames:
            frame = await frames.next(PATIENCE)
            assert frame.hips and frame.objects
            np.testing.assert_array_equal(frame.hips.index, [1, 2])
            np.testing.assert_array_equal(frame.hips.position[:, 0], [0.002, 0.003])
            np.testing.assert_array_equal(frame.objects.index, [haptic.object_index(scene, "far")])
            np.testing.assert_array_equal(frame.objects.position, [[1, 0, 0]])
            self.assertEqual(frame.hips.contacts.hip.size, 0)
        async with daemon.subscribe([HIPS], only_in_contact=True) as frames:
            frame = await frames.next(PATIENCE)
            assert frame.hips
            np.testing.assert_array_equal(frame.hips.index, [0])

    async def test_events_and_statistics_are_frames_of_their_own(self) -> None:
        daemon = await self.connect()
        async with daemon.subscribe([EVENTS]) as events, daemon.subscribe([STATS]) as statistics:
            await daemon.arm()
            event, stats = (await events.next(PATIENCE)).event, (await statistics.next(PATIENCE)).stats
        assert event and stats
        self.assertEqual(event.kind, haptic.EventKind.ARMED)
        self.assertEqual(stats.rate_hz, 1000.0)

    async def test_a_subscription_that_is_closed_ends(self) -> None:
        daemon = await self.connect()
        frames = await daemon.subscribe([DEVICES])
        waiting = asyncio.create_task(self.drain(frames))
        await frames.close()
        await frames.close()
        async with asyncio.timeout(PATIENCE):
            await waiting
        self.assertEqual([one async for one in frames], [])
        with self.assertRaises(haptic.NotFound):
            await daemon.call(v1.Request(unsubscribe=v1.Unsubscribe(subscription=frames.number)))

    async def drain(self, frames: haptic.Subscription) -> None:
        async for _ in frames:
            pass

    async def test_next_gives_up_in_time(self) -> None:
        daemon = await self.connect()
        async with daemon.subscribe([EVENTS]) as frames:
            with self.assertRaises(TimeoutError):
                await frames.next(0.01)


def tick(sequence: int, subscription: int = 7) -> v1.Envelope:
    """The frame of this number is of ten times that tick."""
    return v1.Envelope(frame=v1.Frame(sequence=sequence, subscription=subscription, tick=10 * sequence))


def gap(first: int, last: int, subscription: int = 7) -> v1.Envelope:
    return v1.Envelope(gap=v1.Gap(
        subscription=subscription, first_sequence=first, last_sequence=last,
        first_tick=10 * first, last_tick=10 * last))


class Losses(FakeDaemonTest):
    async def subscription(self, *envelopes: v1.Envelope, limit: int = 1_000_000) -> haptic.Subscription:
        """Of these, which come in one piece with the answer. Then the daemon ends the connection."""
        async def talk(fake: FakeDaemon) -> None:
            await fake.answer_subscribe(7, *envelopes)

        daemon = await self.connect(talk)
        return await daemon.subscribe([OBJECTS], limit=limit)

    async def taken(self, frames: haptic.Subscription) -> list[haptic.Frame]:
        taken = []
        with self.assertRaises(haptic.Unreachable):
            async for frame in frames:
                taken.append(frame)
        return taken

    async def test_frames_that_come_with_the_answer_are_there(self) -> None:
        taken = await self.taken(await self.subscription(tick(1), tick(2), tick(3, subscription=8)))
        self.assertEqual([one.sequence for one in taken], [1, 2])

    async def test_batches_are_frames(self) -> None:
        batch = v1.Envelope(batch=v1.FrameBatch(frame=[tick(1).frame, tick(2).frame]))
        taken = await self.taken(await self.subscription(batch, tick(3)))
        self.assertEqual([one.sequence for one in taken], [1, 2, 3])

    async def test_a_gap_stands_at_the_frame_after_it(self) -> None:
        frames = await self.subscription(tick(1), gap(2, 4), gap(5, 6, subscription=8), tick(5), tick(6))
        taken = await self.taken(frames)
        self.assertEqual([one.gap for one in taken], [None, haptic.Gap(2, 4, 20, 40), None])
        self.assertEqual(frames.lost, 3)

    async def test_what_is_not_taken_in_time_becomes_a_gap(self) -> None:
        room = 2 * tick(1).frame.ByteSize()
        frames = await self.subscription(tick(1), gap(2, 2), tick(3), tick(4), tick(5), limit=room)
        taken = await self.taken(frames)
        self.assertEqual([(one.sequence, one.gap) for one in taken], [(4, haptic.Gap(1, 3, 10, 30)), (5, None)])

    async def test_a_frame_that_cannot_be_read_is_an_error_in_words(self) -> None:
        odd = v1.Envelope(frame=v1.Frame(
            subscription=7, sequence=1, objects=v1.ObjectsFrame(position=[1, 2, 3, 4])))
        frames = await self.subscription(odd)
        with self.assertRaisesRegex(haptic.Unreachable, "position has 4 numbers, which is no multiple of 3"):
            await frames.next(PATIENCE)


class Inboxes(unittest.IsolatedAsyncioTestCase):
    async def test_only_the_newest_stays_where_there_is_no_room(self) -> None:
        inbox = Inbox(0)
        for sequence in (1, 2, 3):
            inbox.put(tick(sequence).frame)
        self.assertEqual(inbox.waiting, 1)
        self.assertEqual(await inbox.get(), (haptic.Gap(1, 2, 10, 20), tick(3).frame))

    async def test_room_is_there_again_for_what_was_taken(self) -> None:
        inbox = Inbox(tick(1).frame.ByteSize())
        for sequence in (1, 2, 3):
            inbox.put(tick(sequence).frame)
            self.assertEqual(await inbox.get(), (None, tick(sequence).frame))


class Decoding(unittest.TestCase):
    def test_lists_that_do_not_fit_together_are_refused(self) -> None:
        cases = {
            "objects have 2 of orientation, 1 of position": v1.Frame(objects=v1.ObjectsFrame(
                position=3 * [0], orientation=8 * [0], velocity=3 * [0], angular_velocity=3 * [0], force=3 * [0],
                torque=3 * [0])),
            "objects have 0 rows and 1 indices": v1.Frame(objects=v1.ObjectsFrame(object=[1])),
            "HIPs have 1 of position, 2 of force": v1.Frame(hips=v1.HipsFrame(position=3 * [0], force=6 * [0])),
            "HIPs have 1 rows and 2 indices": v1.Frame(
                hips=v1.HipsFrame(position=3 * [0], force=3 * [0], hip=[0, 1])),
            "contacts have 1 of hip, 0 of object": v1.Frame(hips=v1.HipsFrame(contact_hip=[0])),
            "contact_proxy has 2 numbers": v1.Frame(hips=v1.HipsFrame(contact_proxy=[0, 0])),
            "devices have 1 of position": v1.Frame(devices=v1.DevicesFrame(position=3 * [0])),
            "orientation has 3 numbers, which is no multiple of 4": v1.Frame(
                devices=v1.DevicesFrame(orientation=3 * [0])),
        }
        for message, frame in cases.items():
            with self.subTest(message), self.assertRaisesRegex(MalformedFrame, message):
                decode(frame)

    def test_an_enumerator_of_a_newer_daemon_is_zero(self) -> None:
        hips = v1.HipsFrame(contact_hip=[0], contact_object=[0], contact_slipping=[False], contact_proxy=3 * [0],
                            contact_force=3 * [0])
        message = v1.Frame()
        # packed field 5 of the HIPs, contact_state: 300
        message.hips.MergeFromString(hips.SerializeToString() + b"\x2a\x02\xac\x02")
        decoded = decode(message)
        assert decoded.hips
        np.testing.assert_array_equal(decoded.hips.contacts.state, [0])


if __name__ == "__main__":
    unittest.main()
