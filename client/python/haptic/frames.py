"""Frames of a subscription as numpy arrays.

World frame, SI units, quaternions w first. Rows are in the order of the scene's objects, of its fingers and their HIPs,
and of the config's devices; `index` tells which ones they are if the subscription selects.
"""

from __future__ import annotations

from collections.abc import Iterable, Sized
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from haptic import v1
from haptic.enums import DevicePhase, FaultKind, State

Floats = NDArray[np.float64]
Indices = NDArray[np.uint32]
Small = NDArray[np.uint8]
Booleans = NDArray[np.bool_]


class MalformedFrame(Exception):
    """The lists of a frame do not fit together."""


@dataclass(frozen=True, eq=False)
class Objects:
    """n objects of one tick."""

    index: Indices  # (n,) place in the scene's list of objects
    position: Floats  # (n, 3) of the object frame, m
    orientation: Floats  # (n, 4) w, x, y, z
    velocity: Floats  # (n, 3) of the centre of gravity, m/s
    angular_velocity: Floats  # (n, 3) rad/s
    force: Floats  # (n, 3) by HIPs, N
    torque: Floats  # (n, 3) by HIPs, about the centre of gravity, N m


@dataclass(frozen=True, eq=False)
class Contacts:
    """m contacts of one tick: an item for each object that holds a HIP, i.e. whose state is not OUT."""

    hip: Indices  # (m,) which HIP, as in Hips.index
    object: Indices  # (m,) by which object, as in Objects.index
    state: Small  # (m,) haptic.State
    slipping: Booleans  # (m,)
    proxy: Floats  # (m, 3) m
    force: Floats  # (m, 3) on the user, N


@dataclass(frozen=True, eq=False)
class Hips:
    """n HIPs of one tick."""

    index: Indices  # (n,) place among the scene's HIPs; haptic.hips_of() tells those of a finger
    position: Floats  # (n, 3) m
    force: Floats  # (n, 3) k (proxy - HIP), summed over objects, on the user, before the guard, N
    contacts: Contacts


@dataclass(frozen=True, eq=False)
class Devices:
    """n devices of one tick."""

    position: Floats  # (n, 3) m
    orientation: Floats  # (n, 4) w, x, y, z
    velocity: Floats  # (n, 3) m/s
    force: Floats  # (n, 3) what the guard let through, on the user, N
    torque: Floats  # (n, 3) N m
    sample_age: Floats  # (n,) s
    buttons: Indices  # (n,) bit k: button k is down
    present: Booleans  # (n,) there is a fresh sample
    fault: Small  # (n,) haptic.FaultKind
    acceleration: Floats  # (n, 3) m/s^2; zero from a daemon that does not tell it, as all that follow
    limits: Indices  # (n,) bit k: haptic.LimitKind k acts
    energy: Floats  # (n,) given to the user beyond what was taken, since it was armed, J
    phase: Small  # (n,) haptic.DevicePhase; 0 of a daemon that does not tell it


@dataclass(frozen=True)
class Gap:
    """Frames that did not arrive, because the daemon or this program was too slow."""

    first_sequence: int
    last_sequence: int
    first_tick: int
    last_tick: int

    @property
    def count(self) -> int:
        """How many frames are lost."""
        return self.last_sequence - self.first_sequence + 1

    def joined(self, later: Gap) -> Gap:
        """Both gaps in one; nothing but lost frames is between them."""
        return Gap(
            self.first_sequence,
            max(self.last_sequence, later.last_sequence),
            self.first_tick,
            max(self.last_tick, later.last_tick),
        )


@dataclass(frozen=True, eq=False)
class Frame:
    """What a subscriber receives: one tick, or one event, or statistics. What was not subscribed to is None."""

    sequence: int  # from 1; ascends by one for each frame of a subscription, those lost included
    subscription: int
    tick: int  # servo periods since start
    monotonic_ns: int  # CLOCK_MONOTONIC
    realtime_ns: int  # CLOCK_REALTIME
    scene_revision: int
    armed: bool
    paused: bool
    objects: Objects | None
    hips: Hips | None
    devices: Devices | None
    stats: v1.Stats | None  # alone in its frame
    event: v1.Event | None  # alone in its frame
    gap: Gap | None  # what is lost between the frame before and this one


class _Numbers(Sized, Iterable[Any], Protocol):
    """A repeated field."""


def _array(values: _Numbers, kind: type[np.generic]) -> NDArray[Any]:
    return np.fromiter(values, kind, len(values))


def _enumerators(values: _Numbers, last: int) -> Small:
    """One that is not known, of a newer daemon, is the zero of its enum."""
    known = _array(values, np.int32)
    known[(known < 0) | (known > last)] = 0
    return known.astype(np.uint8)


def _columns(name: str, values: _Numbers, width: int) -> Floats:
    if len(values) % width:
        raise MalformedFrame(f"{name} has {len(values)} numbers, which is no multiple of {width}")
    return _array(values, np.float64).reshape(-1, width)


def _check_rows(name: str, **columns: NDArray[Any]) -> int:
    """How many rows all of the columns have."""
    rows = {column: len(values) for column, values in columns.items()}
    if len(set(rows.values())) > 1:
        raise MalformedFrame(f"{name} have " + ", ".join(f"{count} of {column}" for column, count in rows.items()))
    return next(iter(rows.values()))


def _index(name: str, chosen: _Numbers, rows: int) -> Indices:
    if not chosen:
        return np.arange(rows, dtype=np.uint32)
    if len(chosen) != rows:
        raise MalformedFrame(f"{name} have {rows} rows and {len(chosen)} indices")
    return _array(chosen, np.uint32)


def _objects(frame: v1.ObjectsFrame) -> Objects:
    vectors = {
        name: _columns(name, getattr(frame, name), 3)
        for name in ("position", "velocity", "angular_velocity", "force", "torque")
    }
    orientation = _columns("orientation", frame.orientation, 4)
    rows = _check_rows("objects", orientation=orientation, **vectors)
    return Objects(index=_index("objects", frame.object, rows), orientation=orientation, **vectors)


def _contacts(frame: v1.HipsFrame) -> Contacts:
    columns: dict[str, NDArray[Any]] = {
        "hip": _array(frame.contact_hip, np.uint32),
        "object": _array(frame.contact_object, np.uint32),
        "state": _enumerators(frame.contact_state, max(State)),
        "slipping": _array(frame.contact_slipping, np.bool_),
        "proxy": _columns("contact_proxy", frame.contact_proxy, 3),
        "force": _columns("contact_force", frame.contact_force, 3),
    }
    _check_rows("contacts", **columns)
    return Contacts(**columns)


def _hips(frame: v1.HipsFrame) -> Hips:
    position = _columns("position", frame.position, 3)
    force = _columns("force", frame.force, 3)
    rows = _check_rows("HIPs", position=position, force=force)
    return Hips(_index("HIPs", frame.hip, rows), position, force, _contacts(frame))


def _devices(frame: v1.DevicesFrame) -> Devices:
    columns: dict[str, NDArray[Any]] = {
        name: _columns(name, getattr(frame, name), 3) for name in ("position", "velocity", "force", "torque")
    }
    columns["orientation"] = _columns("orientation", frame.orientation, 4)
    columns["sample_age"] = _array(frame.sample_age, np.float64)
    columns["buttons"] = _array(frame.buttons, np.uint32)
    columns["present"] = _array(frame.present, np.bool_)
    columns["fault"] = _enumerators(frame.fault, max(FaultKind))
    rows = len(columns["present"])  # what follows is not told by older daemons
    columns["acceleration"] = _columns("acceleration", frame.acceleration or np.zeros(3 * rows), 3)
    columns["limits"] = _array(frame.limits or np.zeros(rows), np.uint32)
    columns["energy"] = _array(frame.energy or np.zeros(rows), np.float64)
    columns["phase"] = _enumerators(frame.phase or [0] * rows, max(DevicePhase))
    _check_rows("devices", **columns)
    return Devices(**columns)


def gap_of(gap: v1.Gap) -> Gap:
    """The gap as the daemon tells it."""
    return Gap(gap.first_sequence, gap.last_sequence, gap.first_tick, gap.last_tick)


def gap_instead_of(frame: v1.Frame) -> Gap:
    """The gap that a frame leaves which is thrown away."""
    return Gap(frame.sequence, frame.sequence, frame.tick, frame.tick)


def decode(frame: v1.Frame, gap: Gap | None = None) -> Frame:
    """The frame as arrays. Raises MalformedFrame."""
    return Frame(
        sequence=frame.sequence,
        subscription=frame.subscription,
        tick=frame.tick,
        monotonic_ns=frame.monotonic_ns,
        realtime_ns=frame.realtime_ns,
        scene_revision=frame.scene_revision,
        armed=frame.armed,
        paused=frame.paused,
        objects=_objects(frame.objects) if frame.HasField("objects") else None,
        hips=_hips(frame.hips) if frame.HasField("hips") else None,
        devices=_devices(frame.devices) if frame.HasField("devices") else None,
        stats=frame.stats if frame.HasField("stats") else None,
        event=frame.event if frame.HasField("event") else None,
        gap=gap,
    )
