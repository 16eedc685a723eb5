#!/usr/bin/env python3
"""Draws the force that each finger feels while it happens: as bars in the terminal, or over time in a picture.

    plot_force.py                                  bars, until Ctrl-C
    plot_force.py --seconds 5 --picture force.svg  needs python3-matplotlib
"""

import argparse
import asyncio
import sys

import numpy as np
from numpy.typing import NDArray

import haptic

WIDTH = 50


async def follow(options: argparse.Namespace) -> int:
    times: list[float] = []
    forces: list[list[float]] = []
    async with haptic.connect(options.socket, program="plot_force.py") as daemon:
        rate = (await daemon.status()).rate_hz
        scene = await daemon.scene()
        decimation = max(1, round(rate / options.rate))
        # a picture wants every frame, a terminal the newest one
        delivery = haptic.Delivery.LOSSLESS if options.picture else haptic.Delivery.LATEST
        async with daemon.subscribe([haptic.Topic.HIPS], decimation=decimation, delivery=delivery) as frames:
            async for frame in frames:
                if frame.scene_revision != scene.revision:
                    scene = await daemon.scene()
                    times, forces = [], []
                    continue  # whose HIPs these are is known from the next frame on
                assert frame.hips
                now = frame.tick / rate
                felt = [frame.hips.force[haptic.hips_of(scene, one.name)].sum(axis=0) for one in scene.finger]
                times.append(now)
                forces.append([float(np.linalg.norm(one)) for one in felt])
                if not options.picture:
                    show(now, [one.name for one in scene.finger], forces[-1], options.full)
                if options.seconds and now - times[0] >= options.seconds:
                    break
    if options.picture:
        draw(options.picture, np.array(times), np.array(forces), [one.name for one in scene.finger])
    return 0


def show(now: float, fingers: list[str], forces: list[float], full: float) -> None:
    lines = [f"{now:10.3f} s"]
    for finger, force in zip(fingers, forces):
        bar = "#" * min(WIDTH, round(WIDTH * force / full))
        lines.append(f"{finger:>12} {force:7.3f} N |{bar:<{WIDTH}}|")
    if sys.stdout.isatty():
        print("\x1b[H\x1b[J" + "\n".join(lines), flush=True)
    else:
        print("  ".join(lines), flush=True)


def draw(file: str, times: NDArray[np.float64], forces: NDArray[np.float64], names: list[str]) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(8, 4), layout="constrained")
    for finger, name in enumerate(names):
        axes.plot(times, forces[:, finger], label=name)
    axes.set_xlabel("time / s")
    axes.set_ylabel("force on the user / N")
    axes.legend()
    figure.savefig(file)
    print(f"{len(times)} frames in {file}")


def main() -> int:
    parser = argparse.ArgumentParser(description="Draws the force that each finger feels.")
    parser.add_argument("--picture", default="", help="a file for a plot over time: .svg, .png, .pdf")
    parser.add_argument("--seconds", type=float, default=0.0, help="end after so long; default: at Ctrl-C")
    parser.add_argument("--rate", type=float, default=20.0, help="frames a second; default: 20")
    parser.add_argument("--full", type=float, default=5.0, help="the force of a whole bar, in N; default: 5")
    parser.add_argument("--socket", default="", help="the daemon's: a path, or host:port")
    options = parser.parse_args()
    if options.picture and not options.seconds:
        parser.error("a picture needs --seconds")
    try:
        return asyncio.run(follow(options))
    except haptic.Error as error:
        print(f"plot_force.py: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        return 0


if __name__ == "__main__":
    sys.exit(main())
