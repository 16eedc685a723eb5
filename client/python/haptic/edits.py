"""Edits of the scene that runs, for Connection.edit():

    await daemon.edit(
        edits.add_material(v1.Material(name="ice", density=900, rigid=v1.Material.Rigid())),
        edits.move_object("box", position=(0.0, 0.05, 0.0)),
    )

Positions are in metres, orientations quaternions w first; tuples, lists and numpy arrays will do.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from haptic import v1

Numbers = Sequence[float] | NDArray[np.float64]


def vector(values: Numbers) -> v1.Vector3:
    """x, y, z as a message. Raises ValueError unless there are three."""
    x, y, z = (float(value) for value in values)
    return v1.Vector3(x=x, y=y, z=z)


def quaternion(values: Numbers) -> v1.Quaternion:
    """w, x, y, z as a message. Raises ValueError unless there are four."""
    w, x, y, z = (float(value) for value in values)
    return v1.Quaternion(w=w, x=x, y=y, z=z)


def pose(position: Numbers = (0.0, 0.0, 0.0), orientation: Numbers = (1.0, 0.0, 0.0, 0.0)) -> v1.Pose:
    """Takes coordinates in the frame that is placed to the frame that it is placed in."""
    return v1.Pose(position=vector(position), orientation=quaternion(orientation))


def add_object(new: v1.Object) -> v1.SceneEdit:
    """It gives no force to HIPs that it appears around until they have left it."""
    return v1.SceneEdit(add_object=new)


def remove_object(name: str) -> v1.SceneEdit:
    """With all that it holds."""
    return v1.SceneEdit(remove_object=name)


def move_object(
    name: str, position: Numbers, orientation: Numbers = (1.0, 0.0, 0.0, 0.0)
) -> v1.SceneEdit:
    """At rest at the new place in the world; HIPs that are then inside it are swallowed."""
    return v1.SceneEdit(move_object=v1.SceneEdit.MoveObject(name=name, pose=pose(position, orientation)))


def set_object(changed: v1.Object, fields: Sequence[str]) -> v1.SceneEdit:
    """Takes the named fields ("inside", "dynamic.linear_viscosity", ...) over into the object of its name."""
    return v1.SceneEdit(set_object=v1.SceneEdit.SetObject(object=changed, field=fields))


def add_material(new: v1.Material) -> v1.SceneEdit:
    """Its name must be new."""
    return v1.SceneEdit(add_material=new)


def set_material(changed: v1.Material) -> v1.SceneEdit:
    """Replaces the one of this name."""
    return v1.SceneEdit(set_material=changed)


def remove_material(name: str) -> v1.SceneEdit:
    """Refused while an object is made of it."""
    return v1.SceneEdit(remove_material=name)


def set_gravity(acceleration: Numbers) -> v1.SceneEdit:
    """In m/s^2, world frame."""
    return v1.SceneEdit(set_gravity=vector(acceleration))


def add_finger(new: v1.Finger) -> v1.SceneEdit:
    """Its name must be new."""
    return v1.SceneEdit(add_finger=new)


def set_finger(changed: v1.Finger) -> v1.SceneEdit:
    """Replaces the one of this name."""
    return v1.SceneEdit(set_finger=changed)


def remove_finger(name: str) -> v1.SceneEdit:
    """Its HIPs are gone with it."""
    return v1.SceneEdit(remove_finger=name)
