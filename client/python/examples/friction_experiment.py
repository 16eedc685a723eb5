#!/usr/bin/env python3
"""An experiment: how hard does a finger pull on surfaces of different friction?

For each coefficient, in random order, the scene's materials get that friction, the scene begins anew, and while the
device goes its way the ratio of tangential to normal force is measured in every tick in which the finger slips. By
Coulomb's law it is the coefficient of kinetic friction. To be run with friction.txtpb, whose device
strokes a fixed block:

    hapticd run --config client/python/examples/friction.txtpb --socket /tmp/hapticd.sock
    friction_experiment.py --socket /tmp/hapticd.sock --csv trials.csv
"""

import argparse
import asyncio
import csv
import random
import sys

import numpy as np
from numpy.typing import NDArray

import haptic
from haptic import edits, v1


def with_friction(scene: v1.Scene, coefficient: float) -> list[v1.SceneEdit]:
    """Gives every rigid material of the scene this kinetic friction, and a fifth more while it holds."""
    changed = []
    for material in scene.material:
        if material.HasField("rigid"):
            rigid = v1.Material.Rigid(static_friction=1.2 * coefficient, kinetic_friction=coefficient)
            changed.append(edits.set_material(
                v1.Material(name=material.name, density=material.density, rigid=rigid)))
    return changed


def ratios(contacts: haptic.Contacts, normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """Tangential by normal force, of each contact that slips on its surface."""
    force = contacts.force[contacts.slipping & (contacts.state == haptic.State.SUR)]
    along = force @ normal
    across: NDArray[np.float64] = np.linalg.norm(force - np.outer(along, normal), axis=1)
    felt: NDArray[np.float64] = across[along > 0] / along[along > 0]
    return felt


async def trial(daemon: haptic.Connection, scene: v1.Scene, coefficient: float, samples: int) -> NDArray[np.float64]:
    """The ratio in so many contacts that slip."""
    await daemon.edit(*with_friction(scene, coefficient))
    await daemon.reset_scene()
    revision = (await daemon.scene()).revision
    measured: list[float] = []
    async with daemon.subscribe([haptic.Topic.HIPS]) as frames:
        async for frame in frames:
            if frame.hips and frame.scene_revision == revision:
                measured += ratios(frame.hips.contacts, np.array([0.0, 1.0, 0.0])).tolist()
            if len(measured) >= samples:
                break
    return np.array(measured[:samples])


async def experiment(options: argparse.Namespace) -> int:
    coefficients = [float(one) for one in options.coefficients.split(",")]
    random.Random(options.seed).shuffle(coefficients)
    rows = []
    async with haptic.connect(options.socket, program="friction_experiment.py") as daemon:
        scene = (await daemon.scene()).scene
        for coefficient in coefficients:
            measured = await trial(daemon, scene, coefficient, options.samples)
            rows.append((coefficient, float(measured.mean()), float(measured.std()), len(measured)))
            print(f"friction {coefficient:5.3f}: felt {rows[-1][1]:.4f}, standard deviation {rows[-1][2]:.1e}")
        await daemon.load_scene(scene)
    if options.csv:
        with open(options.csv, "w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(("friction", "ratio_mean", "ratio_std", "samples"))
            table.writerows(rows)
    return 0


def main() -> int:
    parser = argparse.ArgumentParser(description="Measures friction by what a finger feels.")
    parser.add_argument("--coefficients", default="0.1,0.2,0.4", help="of kinetic friction, with commas")
    parser.add_argument("--samples", type=int, default=100, help="contacts that slip, for each; default: 100")
    parser.add_argument("--seed", type=int, default=1, help="of the order of the trials; default: 1")
    parser.add_argument("--csv", default="", help="a table of the trials")
    parser.add_argument("--socket", default="", help="the daemon's: a path, or host:port")
    try:
        return asyncio.run(experiment(parser.parse_args()))
    except haptic.Error as error:
        print(f"friction_experiment.py: {error}", file=sys.stderr)
        return error.exit_code


if __name__ == "__main__":
    sys.exit(main())
