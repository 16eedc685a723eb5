"""Each request of the schema as a method."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Sequence

from haptic import v1
from haptic.enums import DeviceAction

_SCENE_TIMEOUT = 120.0  # s; a large mesh takes its time
_SLOWEST_RATE = 100.0  # Hz


class Calls(ABC):
    """What a connection can ask. Each raises what the daemon answers, by its type (haptic.errors), or Unreachable."""

    @property
    @abstractmethod
    def _patience(self) -> float:
        """For an answer, in seconds."""

    @abstractmethod
    async def call(self, request: v1.Request, *, timeout: float | None = None) -> v1.Response:
        """Sends any request of the schema and waits for its response."""

    # --- looking ---------------------------------------------------------------------------------------------------

    async def status(self) -> v1.Status:
        """The tick, the rate, whether armed or paused, faults, and how much there is of what."""
        return (await self.call(v1.Request(get_status=v1.GetStatus()))).status

    async def devices(self) -> list[v1.DeviceStatus]:
        """In the order of the config: where each is, its phase (haptic.DevicePhase), and why it is not ready."""
        return list((await self.call(v1.Request(list_devices=v1.ListDevices()))).devices.device)

    async def scene(self) -> v1.SceneDescription:
        """The scene that runs, and what was made of it."""
        return (await self.call(v1.Request(get_scene=v1.GetScene()))).scene

    async def stats(self, *, reset: bool = False) -> v1.Stats:
        """How long ticks take and what the constraint does; `reset` begins to count anew afterwards."""
        return (await self.call(v1.Request(get_stats=v1.GetStats(reset=reset)))).stats

    async def faults(self) -> list[v1.FaultList.FaultRecord]:
        """The last hundred since the daemon's start, the oldest first; which are latched, where each is recorded."""
        return list((await self.call(v1.Request(list_faults=v1.ListFaults()))).faults.fault)

    async def state(self) -> v1.WorldState:
        """All that a tick changes, after one tick, to the bit: where a replay can start from."""
        return (await self.call(v1.Request(get_state=v1.GetState()))).state

    # --- the scene: role SCRIPT ------------------------------------------------------------------------------------

    async def load_scene(self, scene: v1.Scene) -> v1.SceneDescription:
        """Runs another scene, sent from here: see haptic.read_scene(). It may name no mesh file."""
        request = v1.Request(load_scene=v1.LoadScene(scene=scene))
        return (await self.call(request, timeout=max(self._patience, _SCENE_TIMEOUT))).scene

    async def load_scene_file(self, path: str | os.PathLike[str]) -> v1.SceneDescription:
        """Runs another scene, which the daemon itself reads from a file on its machine, with the meshes it names."""
        request = v1.Request(load_scene=v1.LoadScene(path=os.path.abspath(path)))
        return (await self.call(request, timeout=max(self._patience, _SCENE_TIMEOUT))).scene

    async def edit(self, *edits: v1.SceneEdit, expected_revision: int = 0) -> None:
        """Changes the scene that runs, between two ticks: all of the edits (haptic.edits) or none.

        Refused unless the scene of `expected_revision` runs; 0: whatever runs.
        """
        await self.call(
            v1.Request(edit_scene=v1.EditScene(edit=edits, expected_revision=expected_revision)),
            timeout=max(self._patience, _SCENE_TIMEOUT))

    async def reset_scene(self) -> None:
        """Puts all objects back to where they started."""
        await self.call(v1.Request(reset_scene=v1.ResetScene()))

    async def pause(self) -> None:
        """Holds the scene still; no forces meanwhile. Raises NothingToDo if it is."""
        await self.call(v1.Request(pause=v1.Pause()))

    async def resume(self) -> None:
        """Lets it go on. Raises NothingToDo if it does."""
        await self.call(v1.Request(resume=v1.Resume()))

    async def step(self, ticks: int = 1) -> None:
        """Runs so many ticks while paused, at the servo's rate, and returns when they have run."""
        await self.call(v1.Request(step=v1.Step(ticks=ticks)), timeout=self._patience + ticks / _SLOWEST_RATE)

    # --- a virtual device: role DRIVE ------------------------------------------------------------------------------

    async def move_device(
        self,
        device: str,
        position: Sequence[float],
        orientation: Sequence[float] = (1.0, 0.0, 0.0, 0.0),
        velocity: Sequence[float] | None = None,
        *,
        buttons: int = 0,
        sequence: int = 0,
        monotonic_ns: int = 0,
    ) -> v1.DeviceForce:
        """Tells where a device of the driver "virtual" is, in the world, and returns what it shall do to its user.

        Position in m; orientation w, x, y, z; velocity in m/s, otherwise as the positions tell. To be called again
        within safety.max_sample_age. `sequence` and `monotonic_ns`: see MoveDevice in the schema. Raises Refused while
        another client drives or moves it, NothingToDo if a newer sample has come before.
        """
        x, y, z = position
        qw, qx, qy, qz = orientation
        move = v1.MoveDevice(
            device=device,
            pose=v1.Pose(position=v1.Vector3(x=x, y=y, z=z), orientation=v1.Quaternion(w=qw, x=qx, y=qy, z=qz)),
            buttons=buttons, sequence=sequence, monotonic_ns=monotonic_ns)
        if velocity is not None:
            vx, vy, vz = velocity
            move.velocity.CopyFrom(v1.Vector3(x=vx, y=vy, z=vz))
        return (await self.call(v1.Request(move_device=move))).device_force

    # --- the life of a device: role DRIVE --------------------------------------------------------------------------

    async def manage_device(self, device: str, action: DeviceAction) -> None:
        """Asks a device to show which one it is, to be homed or calibrated again, or to be opened again.

        Raises Refused while it is armed or another client drives, Unsupported if its driver does not know the action,
        Error if it is not open.
        """
        managed = v1.ManageDevice(device=device, action=v1.ManageDevice.Action.Name(action))
        await self.call(v1.Request(manage_device=managed))

    # --- forces: role DRIVE; faults: role ADMIN --------------------------------------------------------------------

    async def arm(self) -> None:
        """Allows force.

        Raises NothingToDo if it is allowed, FaultLatched, Refused while another client drives, or Error while more than
        safety.max_arm_force waits to push on a device.
        """
        await self.call(v1.Request(arm=v1.Arm()))

    async def disarm(self) -> None:
        """Forbids force. Raises NothingToDo if it is forbidden."""
        await self.call(v1.Request(disarm=v1.Disarm()))

    async def emergency_stop(self) -> None:
        """Ends all force in the next tick and latches a fault; role SCRIPT, whoever drives, at any rate."""
        await self.call(v1.Request(emergency_stop=v1.EmergencyStop()))

    async def clear_fault(self) -> None:
        """Clears what is latched. Find its cause first; raises NothingToDo if there is none."""
        await self.call(v1.Request(clear_fault=v1.ClearFault()))
