"""Frames of one subscription, as they arrive."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable
from types import TracebackType

from haptic import v1
from haptic.errors import Error, Unreachable
from haptic.frames import Frame, Gap, MalformedFrame, decode, gap_instead_of


class Inbox:
    """Frames that have arrived and were not yet taken, of at most `limit` bytes; beyond, the oldest go first.

    Reading never waits for a program that takes no frames: what it does not take in time becomes a gap. The newest
    frame always stays, so a limit of 0 keeps just that one.
    """

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._bytes = 0
        self._waiting: deque[tuple[Gap | None, v1.Frame]] = deque()
        self._gap: Gap | None = None  # since the last frame
        self._end: Error | None = None
        self._ended = False
        self._news = asyncio.Event()

    @property
    def waiting(self) -> int:
        """How many frames."""
        return len(self._waiting)

    def put(self, frame: v1.Frame) -> None:
        """Takes a frame, in place of the oldest ones if there is no room."""
        self._waiting.append((self._gap, frame))
        self._bytes += frame.ByteSize()
        self._gap = None
        while self._bytes > self._limit and len(self._waiting) > 1:
            gap, oldest = self._pop()
            after, successor = self._waiting[0]
            self._waiting[0] = (_join(_join(gap, gap_instead_of(oldest)), after), successor)
        self._news.set()

    def put_gap(self, gap: Gap) -> None:
        """Takes a gap: it stands before the frame that comes next."""
        self._gap = _join(self._gap, gap)

    def end(self, error: Error | None) -> None:
        """Nothing comes any more. What waits is still given out, then `error` is raised, or None is the answer."""
        self._end = self._end or error
        self._ended = True
        self._news.set()

    async def get(self) -> tuple[Gap | None, v1.Frame] | None:
        """The oldest frame, with the gap before it; None after the end."""
        while not self._waiting:
            if self._end:
                raise self._end
            if self._ended:
                return None
            self._news.clear()
            await self._news.wait()
        return self._pop()

    def _pop(self) -> tuple[Gap | None, v1.Frame]:
        gap, frame = self._waiting.popleft()
        self._bytes -= frame.ByteSize()
        return gap, frame


def _join(first: Gap | None, second: Gap | None) -> Gap | None:
    return first.joined(second) if first and second else first or second


class Subscription:
    """An asynchronous iterator over frames; ends with the subscription or the connection.

        async with daemon.subscribe([haptic.Topic.HIPS]) as frames:
            async for frame in frames:
                print(frame.tick, frame.hips.force.sum(axis=0))

    One task takes frames. If the daemon goes away, what has arrived is given out, and then Unreachable is raised.
    """

    def __init__(self, number: int, inbox: Inbox, unsubscribe: Callable[[int], Awaitable[None]]) -> None:
        self._number = number
        self._inbox = inbox
        self._unsubscribe = unsubscribe
        self._lost = 0
        self._closed = False

    @property
    def number(self) -> int:
        """As frames tell it: Frame.subscription."""
        return self._number

    @property
    def waiting(self) -> int:
        """How many frames have arrived and were not yet taken."""
        return self._inbox.waiting

    @property
    def lost(self) -> int:
        """How many frames are missing between those that were taken."""
        return self._lost

    def __aiter__(self) -> Subscription:
        return self

    async def __anext__(self) -> Frame:
        taken = None if self._closed else await self._inbox.get()
        if taken is None:
            raise StopAsyncIteration
        gap, message = taken
        self._lost += gap.count if gap else 0
        try:
            return decode(message, gap)
        except MalformedFrame as error:
            raise Unreachable(f"a frame of the daemon cannot be read: {error}") from error

    async def next(self, timeout: float | None = None) -> Frame:
        """The next frame, waited for at most `timeout` seconds. Raises TimeoutError, or Unreachable after the end."""
        async with asyncio.timeout(timeout):
            async for frame in self:
                return frame
        raise Unreachable("the subscription has ended")

    async def take(self, count: int, timeout: float | None = None) -> list[Frame]:
        """The next `count` frames, waited for at most `timeout` seconds altogether. Raises as next() does."""
        async with asyncio.timeout(timeout):
            return [await self.next() for _ in range(count)]

    async def close(self) -> None:
        """Ends the subscription; frames that were not taken are dropped."""
        if not self._closed:
            self._closed = True
            self._inbox.end(None)
            await self._unsubscribe(self._number)

    async def __aenter__(self) -> Subscription:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            await self.close()
        except Unreachable:  # there is nothing left to end; whoever takes frames is told
            pass
