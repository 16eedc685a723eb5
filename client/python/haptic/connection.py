"""A client's connection to the daemon: hello, calls, subscriptions, events.

    async with haptic.connect() as daemon:
        print(await daemon.status())
        async with daemon.subscribe([haptic.Topic.OBJECTS], decimation=10) as frames:
            async for frame in frames:
                print(frame.objects.position)

Any number of tasks may call and subscribe at once; each answer goes to whom it is for. All errors are of haptic.errors.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import Coroutine, Generator, Iterable
from contextlib import AbstractAsyncContextManager
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Generic, TypeVar

from google.protobuf.message import DecodeError

from haptic import v1
from haptic.address import Address, Identity, find_address, find_identity
from haptic.calls import Calls
from haptic.drive import DriveLease
from haptic.enums import Delivery, Role, Topic
from haptic.errors import Error, ProtocolMismatch, Unreachable, error_of
from haptic.frames import gap_of
from haptic.framing import FrameReader, FramingError, frame
from haptic.subscription import Inbox, Subscription
from haptic.transport import open_streams, reason_of
from haptic.version import FEATURES, PROTOCOL_MAJOR, PROTOCOL_MINOR, REPLY_LIMIT, VERSION

Opened = TypeVar("Opened", bound=AbstractAsyncContextManager[Any])

TIMEOUT = 10.0  # s
FRAMES_LIMIT = 64 * 1024 * 1024  # bytes
_EVENTS_LIMIT = 1024
_CHUNK = 256 * 1024


class Opening(Generic[Opened]):
    """What is being opened: `x = await opening`, or `async with opening as x`, which closes it in the end."""

    def __init__(self, work: Coroutine[Any, Any, Opened]) -> None:
        self._work = work

    def __await__(self) -> Generator[Any, Any, Opened]:
        return self._work.__await__()

    async def __aenter__(self) -> Opened:
        self._opened = await self._work
        await self._opened.__aenter__()
        return self._opened

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool | None:
        return await self._opened.__aexit__(kind, error, trace)


@dataclass
class _Call:
    """A request that waits for its answer."""

    answer: asyncio.Future[v1.Response]
    inbox: Inbox | None  # of the subscription that the answer begins


class Connection(Calls):
    """Made by connect(). Its calls, one for each request of the schema, are those of haptic.calls.Calls."""

    def __init__(self, address: Address, streams: tuple[asyncio.StreamReader, asyncio.StreamWriter],
                 timeout: float) -> None:
        self._address = address
        self._stream, self._writer = streams
        self._timeout = timeout
        self._frames = FrameReader(REPLY_LIMIT)
        self._hello = v1.Hello()
        self._last_request = 0
        self._calls: dict[int, _Call] = {}
        self._inboxes: dict[int, Inbox] = {}
        self._listeners: set[asyncio.Queue[v1.Event | None]] = set()
        self._end: Error | None = None
        self._reader: asyncio.Task[None] | None = None

    # --- what the daemon said --------------------------------------------------------------------------------------

    @property
    def hello(self) -> v1.Hello:
        """What the daemon said first: its version, features, and what it did not get of the system."""
        return self._hello

    @property
    def role(self) -> Role:
        """What this client may do."""
        return Role(self._hello.role)

    @property
    def address(self) -> Address:
        """Where the daemon is."""
        return self._address

    @property
    def _patience(self) -> float:
        return self._timeout

    # --- calls and subscriptions -----------------------------------------------------------------------------------

    async def call(self, request: v1.Request, *, timeout: float | None = None) -> v1.Response:
        """Sends any request of the schema and waits for its response; the id is chosen here.

        Raises what the daemon answered, by its type, or Unreachable after `timeout` seconds (default: that of
        connect()). The timeout ends the waiting, not what the daemon does.
        """
        return await self._ask(request, None, timeout)

    def subscribe(
        self,
        topics: Iterable[Topic],
        *,
        decimation: int = 1,
        delivery: Delivery = Delivery.LOSSLESS,
        fingers: Iterable[str] = (),
        objects: Iterable[str] = (),
        only_in_contact: bool = False,
        limit: int = FRAMES_LIMIT,
    ) -> Opening[Subscription]:
        """Frames of these topics, one for `decimation` ticks.

        LOSSLESS, for logs and experiments: frames wait for whoever takes them, in the daemon and here, up to `limit`
        bytes; what is lost then, a frame's gap tells. LATEST, for views: a newer frame takes the place of one that
        waits. `fingers` and `objects` select by name, and raise NotFound for one that is not in the scene;
        `only_in_contact` selects the HIPs that a surface holds or a material pushes.
        """
        wish = v1.Subscribe(
            topic=[v1.Topic.Name(topic) for topic in topics],
            decimation=decimation,
            delivery=v1.Delivery.Name(delivery),
            finger=fingers,
            object=objects,
            only_in_contact=only_in_contact,
        )
        return Opening(self._subscribe(wish, 0 if delivery == Delivery.LATEST else limit))

    def drive(self, *, silence: float = 0.0, keep_armed: bool = False) -> DriveLease:
        """The drive lease, with heartbeats while it is held: see DriveLease."""
        return DriveLease(self, silence, keep_armed)

    def events(self) -> Events:
        """What happens from now on: armed, faults, changes of the scene, ..."""
        return Events(self._listeners, self._end)

    async def close(self) -> None:
        """Ends the connection; calls that wait raise Unreachable, and subscriptions end."""
        if self._reader is None:
            return
        self._reader.cancel()
        await asyncio.wait([self._reader])
        self._reader = None
        self._finish(Unreachable("the connection was closed"), None)
        self._writer.close()
        try:
            await self._writer.wait_closed()
        except OSError:
            pass  # the other side was faster

    async def __aenter__(self) -> Connection:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    # --- sending ---------------------------------------------------------------------------------------------------

    async def _subscribe(self, wish: v1.Subscribe, limit: int) -> Subscription:
        inbox = Inbox(limit)
        response = await self._ask(v1.Request(subscribe=wish), inbox, None)
        return Subscription(response.subscribed.subscription, inbox, self._unsubscribe)

    async def _unsubscribe(self, number: int) -> None:
        self._inboxes.pop(number, None)  # what is on its way is dropped
        await self.call(v1.Request(unsubscribe=v1.Unsubscribe(subscription=number)))

    async def _ask(self, request: v1.Request, inbox: Inbox | None, timeout: float | None) -> v1.Response:
        if self._end:
            raise self._end
        timeout = self._timeout if timeout is None else timeout
        self._last_request += 1
        number = self._last_request
        message = v1.Request()
        message.CopyFrom(request)
        message.id = number
        call = _Call(asyncio.get_running_loop().create_future(), inbox)
        self._calls[number] = call
        try:
            async with asyncio.timeout(timeout):
                await self._send(v1.Envelope(request=message))
                return await call.answer
        except TimeoutError:
            raise Unreachable(f"the daemon at {self._address} did not answer within {timeout:g} s") from None
        finally:
            self._calls.pop(number, None)

    async def _send(self, envelope: v1.Envelope) -> None:
        try:
            self._writer.write(frame(envelope.SerializeToString()))
            await self._writer.drain()
        except OSError:
            pass  # what is read next tells that nothing can be sent any more, and perhaps why

    # --- receiving -------------------------------------------------------------------------------------------------

    async def _greet(self, program: str, version: str) -> None:
        mine = v1.Hello(
            major=PROTOCOL_MAJOR, minor=PROTOCOL_MINOR, feature=FEATURES, program=program, version=version)
        await self._send(v1.Envelope(hello=mine))
        theirs = await self._receive()
        if not theirs.HasField("hello"):
            raise self._no_daemon("it did not begin with hello")
        self._hello = theirs.hello
        if theirs.hello.major != PROTOCOL_MAJOR:
            raise ProtocolMismatch(
                f"this program speaks protocol {PROTOCOL_MAJOR}.{PROTOCOL_MINOR}, the daemon ({theirs.hello.program} "
                f"{theirs.hello.version}) {theirs.hello.major}.{theirs.hello.minor}; install matching versions")

    async def _receive(self) -> v1.Envelope:
        """The next envelope of a kind that this program knows; a goodbye is raised."""
        while True:
            try:
                message = self._frames.next()
                envelope: v1.Envelope | None = None if message is None else v1.Envelope.FromString(message)
            except (FramingError, DecodeError) as error:
                raise self._no_daemon(str(error)) from error
            if envelope is None:
                self._frames.append(await self._read_chunk())
            elif envelope.HasField("goodbye"):
                raise _goodbye(envelope.goodbye.error)
            elif envelope.WhichOneof("body"):
                return envelope

    async def _read_chunk(self) -> bytes:
        try:
            chunk = await self._stream.read(_CHUNK)
        except OSError as error:
            raise Unreachable(f"the daemon at {self._address} closed the connection: {reason_of(error)}") from error
        if not chunk:
            raise Unreachable(f"the daemon at {self._address} closed the connection")
        return chunk

    def _no_daemon(self, reason: str) -> Unreachable:
        return Unreachable(f"what listens at {self._address} is not a hapticd: {reason}")

    async def _read(self) -> None:
        """The life of the connection."""
        try:
            while True:
                self._dispatch(await self._receive())
        except Error as error:
            self._finish(error, error)
            self._writer.close()

    def _dispatch(self, envelope: v1.Envelope) -> None:
        if envelope.HasField("response"):
            self._answer(envelope.response)
        elif envelope.HasField("frame"):
            self._deliver(envelope.frame)
        elif envelope.HasField("batch"):
            for one in envelope.batch.frame:
                self._deliver(one)
        elif envelope.HasField("gap"):
            inbox = self._inboxes.get(envelope.gap.subscription)
            if inbox is not None:
                inbox.put_gap(gap_of(envelope.gap))
        elif envelope.HasField("event"):
            for queue in self._listeners:
                _push(queue, envelope.event)

    def _deliver(self, message: v1.Frame) -> None:
        inbox = self._inboxes.get(message.subscription)
        if inbox is not None:
            inbox.put(message)

    def _answer(self, response: v1.Response) -> None:
        call = self._calls.get(response.id)
        if call is None or call.answer.done():
            return  # the late answer of a call that was given up
        if response.HasField("error"):
            call.answer.set_exception(error_of(response.error))
            return
        if call.inbox is not None:
            # at once: frames follow in the same chunk
            self._inboxes[response.subscribed.subscription] = call.inbox
        call.answer.set_result(response)

    def _finish(self, for_calls: Error, for_frames: Error | None) -> None:
        """Tells everybody who waits that nothing comes any more."""
        self._end = self._end or for_calls
        for call in self._calls.values():
            if not call.answer.done():
                call.answer.set_exception(for_calls)
        for inbox in self._inboxes.values():
            inbox.end(for_frames)
        for queue in self._listeners:
            _push(queue, None)


def _goodbye(error: v1.Error) -> Error:
    # a daemon that merely ends, or ends this client, is gone; a mismatch or a refusal is more than that
    return Unreachable(error.message) if error.code == v1.Error.FAILED else error_of(error)


def _push(queue: asyncio.Queue[v1.Event | None], event: v1.Event | None) -> None:
    if queue.full():
        queue.get_nowait()  # who does not listen hears the latest
    queue.put_nowait(event)


class Events:
    """An asynchronous iterator over events, from when it was made; ends with the connection.

    The latest 1024 wait for a program that does not listen.
    """

    def __init__(self, listeners: set[asyncio.Queue[v1.Event | None]], end: Error | None) -> None:
        self._queue: asyncio.Queue[v1.Event | None] = asyncio.Queue(_EVENTS_LIMIT)
        self._listeners = listeners
        if end:
            self._queue.put_nowait(None)
        else:
            listeners.add(self._queue)

    def __aiter__(self) -> Events:
        return self

    async def __anext__(self) -> v1.Event:
        event = await self._queue.get()
        if event is None:
            self._queue.put_nowait(None)
            raise StopAsyncIteration
        return event

    def close(self) -> None:
        """Stops listening."""
        self._listeners.discard(self._queue)


def connect(
    address: str | os.PathLike[str] = "",
    *,
    identity: Identity | None = None,
    program: str = "python",
    version: str = VERSION,
    timeout: float = TIMEOUT,
) -> Opening[Connection]:
    """Connects and exchanges Hello: `async with haptic.connect() as daemon`, or `daemon = await haptic.connect()`.

    `address` is a path or host:port; left away, it is found as hapticctl finds it (haptic.address). `identity` is for
    TLS over TCP (default: HAPTICD_CERTIFICATE, HAPTICD_KEY, HAPTICD_AUTHORITY); without one the daemon lets observe
    only. `program` is what the daemon calls this client. `timeout`, in seconds, is for connecting and for each call.

    Raises Unreachable, ProtocolMismatch, Refused, or Invalid for files of TLS that cannot be used.
    """
    return Opening(_connect(address, identity, program, version, timeout))


async def _connect(
    address: str | os.PathLike[str], identity: Identity | None, program: str, version: str, timeout: float
) -> Connection:
    where = find_address(address)
    try:
        async with asyncio.timeout(timeout):
            streams = await open_streams(where, find_identity() if identity is None else identity)
            connection = Connection(where, streams, timeout)
            try:
                await connection._greet(program, version)
            except BaseException:
                connection._writer.close()
                raise
    except TimeoutError:
        raise Unreachable(f"what listens at {where} did not say hello within {timeout:g} s") from None
    connection._reader = asyncio.create_task(connection._read(), name="haptic connection")
    return connection
