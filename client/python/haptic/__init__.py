"""A client of hapticd, the real-time haptics daemon, for asyncio and numpy.

    import asyncio
    import haptic

    async def main() -> None:
        async with haptic.connect() as daemon:
            async with daemon.subscribe([haptic.Topic.HIPS], decimation=10) as frames:
                async for frame in frames:
                    print(frame.tick, frame.hips.force.sum(axis=0))

    asyncio.run(main())

connect() finds the daemon; a Connection calls, subscribes and drives; errors say what hapticctl's exit codes say. The
messages of the schema are in haptic.v1. SI units, world frame, quaternions w first.
"""

from haptic import edits, v1
from haptic.address import Address, Identity
from haptic.connection import Connection, Events, connect
from haptic.drive import DriveLease
from haptic.enums import (
    Delivery, DeviceAction, DevicePhase, EventKind, FaultKind, LimitKind, Role, State, Topic)
from haptic.errors import (
    Busy,
    Error,
    FaultLatched,
    Invalid,
    NotFound,
    NothingToDo,
    ProtocolMismatch,
    Refused,
    Unreachable,
    Unsupported,
)
from haptic.frames import Contacts, Devices, Frame, Gap, Hips, Objects
from haptic.scenes import hips_of, object_index, read_scene, write_scene
from haptic.scripts import run_script
from haptic.subscription import Subscription
from haptic.version import VERSION as __version__

__all__ = [
    "Address",
    "Busy",
    "Connection",
    "Contacts",
    "Delivery",
    "DeviceAction",
    "DevicePhase",
    "Devices",
    "DriveLease",
    "Error",
    "EventKind",
    "Events",
    "FaultKind",
    "FaultLatched",
    "Frame",
    "Gap",
    "Hips",
    "Identity",
    "Invalid",
    "LimitKind",
    "NotFound",
    "NothingToDo",
    "Objects",
    "ProtocolMismatch",
    "Refused",
    "Role",
    "State",
    "Subscription",
    "Topic",
    "Unreachable",
    "Unsupported",
    "__version__",
    "connect",
    "edits",
    "hips_of",
    "object_index",
    "read_scene",
    "run_script",
    "v1",
    "write_scene",
]
