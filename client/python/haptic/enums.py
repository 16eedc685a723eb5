"""The enumerations of the schema as Python's own, so that they print and compare as what they mean."""

from __future__ import annotations

from enum import IntEnum

from haptic import v1


class Topic(IntEnum):
    """What a subscription tells of."""

    OBJECTS = v1.OBJECTS
    HIPS = v1.HIPS
    DEVICES = v1.DEVICES
    EVENTS = v1.EVENTS
    STATS = v1.STATS
    INPUTS = v1.INPUTS


class Delivery(IntEnum):
    """What becomes of frames while the client is slower than they come."""

    LATEST = v1.LATEST
    LOSSLESS = v1.LOSSLESS


class Role(IntEnum):
    """What a client may do; each includes those before it."""

    OBSERVE = v1.OBSERVE
    SCRIPT = v1.SCRIPT
    DRIVE = v1.DRIVE
    ADMIN = v1.ADMIN


class State(IntEnum):
    """What holds a proxy."""

    TET = v1.TET
    SUR = v1.SUR
    EDG = v1.EDG
    VER = v1.VER
    OUT = v1.OUT


class FaultKind(IntEnum):
    """Why forces are zero until a person clears it."""

    NONE = v1.FAULT_NONE
    NOT_FINITE = v1.FAULT_NOT_FINITE
    OVER_SPEED = v1.FAULT_OVER_SPEED
    STALE_SAMPLE = v1.FAULT_STALE_SAMPLE
    MISSED_TICKS = v1.FAULT_MISSED_TICKS
    LOST_DRIVER = v1.FAULT_LOST_DRIVER


class EventKind(IntEnum):
    """What has happened, beside the ticks."""

    UNSPECIFIED = v1.Event.UNSPECIFIED
    ARMED = v1.Event.ARMED
    DISARMED = v1.Event.DISARMED
    PAUSED = v1.Event.PAUSED
    RESUMED = v1.Event.RESUMED
    FAULT_LATCHED = v1.Event.FAULT_LATCHED
    FAULT_CLEARED = v1.Event.FAULT_CLEARED
    SCENE_CHANGED = v1.Event.SCENE_CHANGED
    TICKS_MISSED = v1.Event.TICKS_MISSED
    FAULT_RECORDED = v1.Event.FAULT_RECORDED
