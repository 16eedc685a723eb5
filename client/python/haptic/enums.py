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


class DevicePhase(IntEnum):
    """Where a device stands in its life."""

    ABSENT = v1.DEVICE_ABSENT
    FOUND = v1.DEVICE_FOUND
    OPENING = v1.DEVICE_OPENING
    HOMING = v1.DEVICE_HOMING
    READY = v1.DEVICE_READY
    ARMED = v1.DEVICE_ARMED
    FAULT = v1.DEVICE_FAULT


class DeviceAction(IntEnum):
    """What a person does to one device while it is disarmed."""

    IDENTIFY = v1.ManageDevice.IDENTIFY
    HOME = v1.ManageDevice.HOME
    CALIBRATE = v1.ManageDevice.CALIBRATE
    REOPEN = v1.ManageDevice.REOPEN


class FaultKind(IntEnum):
    """Why forces are zero until a person clears it."""

    NONE = v1.FAULT_NONE
    NOT_FINITE = v1.FAULT_NOT_FINITE
    OVER_SPEED = v1.FAULT_OVER_SPEED
    STALE_SAMPLE = v1.FAULT_STALE_SAMPLE
    MISSED_TICKS = v1.FAULT_MISSED_TICKS
    LOST_DRIVER = v1.FAULT_LOST_DRIVER
    OVER_TRAVEL = v1.FAULT_OVER_TRAVEL
    ENERGY = v1.FAULT_ENERGY
    LOST_DEVICE = v1.FAULT_LOST_DEVICE
    EMERGENCY_STOP = v1.FAULT_EMERGENCY_STOP
    STILL_SAMPLE = v1.FAULT_STILL_SAMPLE


class LimitKind(IntEnum):
    """What the guard does to a force that is too much, without a fault; bit k of Devices.limits is that of kind k."""

    NONE = v1.LIMIT_NONE
    FORCE = v1.LIMIT_FORCE
    RATE = v1.LIMIT_RATE
    RAMP = v1.LIMIT_RAMP
    MEAN_FORCE = v1.LIMIT_MEAN_FORCE
    CLUTCH = v1.LIMIT_CLUTCH


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
    DEVICE_CHANGED = v1.Event.DEVICE_CHANGED
    FAULT_RECORDED = v1.Event.FAULT_RECORDED
