"""The drive lease: while it is held nobody else can arm, and if the holder dies forces go down."""

from __future__ import annotations

import asyncio
from types import TracebackType

from haptic import v1
from haptic.calls import Calls
from haptic.errors import Error, NothingToDo

_BEATS_PER_SILENCE = 4  # so that one late beat is no death


class DriveLease:
    """Holds the lease for as long as the block runs, and sends the heartbeats.

        async with daemon.drive() as lease:
            await daemon.arm()
            ...

    When the block ends, by an exception or not, forces are disarmed and the lease is given back; with `keep_armed` they
    stay as they are if the block ended without an exception. If the lease is lost meanwhile (the daemon took it because
    no heartbeat came, or the daemon is gone), the block is cancelled, and raises the error that told so. Heartbeats are
    sent by the event loop: a program that keeps it from running for longer than `silence` loses the lease, and the
    daemon's config tells what becomes of forces (drive.on_loss).

    `silence`: the longest time without a heartbeat to ask for, in seconds; 0: the longest that the config permits.
    Raises Refused if another client holds the lease.
    """

    def __init__(self, daemon: Calls, silence: float, keep_armed: bool) -> None:
        self._daemon = daemon
        self._asked = silence
        self._keep_armed = keep_armed
        self._agreed = 0.0
        self._error: Error | None = None

    @property
    def silence(self) -> float:
        """As agreed with the daemon, in seconds."""
        return self._agreed

    async def __aenter__(self) -> DriveLease:
        request = v1.Request(acquire_drive=v1.AcquireDrive(heartbeat_ms=round(1000 * self._asked)))
        lease = (await self._daemon.call(request)).drive_lease
        self._agreed = lease.heartbeat_ms / 1000
        holder = asyncio.current_task()
        assert holder is not None
        self._holder = holder
        self._heart = asyncio.create_task(self._beat(), name="haptic heartbeat")
        return self

    async def _beat(self) -> None:
        try:
            while True:
                await asyncio.sleep(self._agreed / _BEATS_PER_SILENCE)
                await self._daemon.call(v1.Request(heartbeat=v1.Heartbeat()))
        except Error as error:
            self._error = error
            self._holder.cancel()

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._error:
            # of the cancelling that reached the block, or would at its next await, nothing is left
            self._holder.uncancel()
            if kind is None or kind is asyncio.CancelledError:
                raise self._error from None
            return
        self._heart.cancel()
        await asyncio.wait([self._heart])
        try:
            if kind is not None or not self._keep_armed:
                await self._disarm()
            await self._daemon.call(v1.Request(release_drive=v1.ReleaseDrive()))
        except Error:
            if kind is None:
                raise  # otherwise what the block raised says more

    async def _disarm(self) -> None:
        try:
            await self._daemon.disarm()
        except NothingToDo:
            pass
