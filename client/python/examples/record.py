#!/usr/bin/env python3
"""Records what HIPs, objects and devices do, every tick or every so many, in one numpy file (.npz).

    record.py --seconds 5 take.npz
    python3 -c "import numpy; take = numpy.load('take.npz'); print(take['time'], take['hip_force'].shape)"

Arrays: tick (n,), time (n,) in seconds since the first, and for m HIPs, objects, devices: hip_position (n, m, 3),
hip_force (n, m, 3), object_position, object_orientation (n, m, 4) w first, device_position, device_force, ...; gap
(k, 2): the first and the last tick of what was lost. A scene that changes ends the recording.
"""

import argparse
import asyncio
import sys

import numpy as np
from numpy.typing import NDArray

import haptic

COLUMNS = {
    "hip": ("position", "force"),
    "object": ("position", "orientation", "velocity", "angular_velocity", "force", "torque"),
    "device": ("position", "orientation", "velocity", "force", "torque"),
}


async def record(file: str, seconds: float, decimation: int, address: str) -> int:
    rows: dict[str, list[NDArray[np.float64]]] = {
        f"{part}_{name}": [] for part, names in COLUMNS.items() for name in names}
    ticks: list[int] = []
    gaps: list[tuple[int, int]] = []
    revision = 0
    topics = [haptic.Topic.HIPS, haptic.Topic.OBJECTS, haptic.Topic.DEVICES]
    async with haptic.connect(address, program="record.py") as daemon:
        status = await daemon.status()
        async with daemon.subscribe(topics, decimation=decimation) as frames:
            async for frame in frames:
                if ticks and (frame.scene_revision != revision or frame.tick - ticks[0] >= seconds * status.rate_hz):
                    break
                revision = frame.scene_revision
                ticks.append(frame.tick)
                if frame.gap:
                    gaps.append((frame.gap.first_tick, frame.gap.last_tick))
                for part, names in COLUMNS.items():
                    for name in names:
                        rows[f"{part}_{name}"].append(getattr(getattr(frame, part + "s"), name))
    tick = np.array(ticks, dtype=np.uint64)
    np.savez_compressed(
        file, tick=tick, time=(tick - tick[0]) / status.rate_hz, gap=np.array(gaps, dtype=np.uint64).reshape(-1, 2),
        **{name: np.stack(values) for name, values in rows.items()})
    print(f"{len(ticks)} frames, {frames.lost} lost, in {file}")
    return 0


def main() -> int:
    parser = argparse.ArgumentParser(description="Records ticks in a numpy file.")
    parser.add_argument("file", help="the .npz to write")
    parser.add_argument("--seconds", type=float, default=5.0, help="how long; default: 5")
    parser.add_argument("--decimation", type=int, default=1, help="one frame for so many ticks; default: each")
    parser.add_argument("--socket", default="", help="the daemon's: a path, or host:port")
    options = parser.parse_args()
    try:
        return asyncio.run(record(options.file, options.seconds, options.decimation, options.socket))
    except haptic.Error as error:
        print(f"record.py: {error}", file=sys.stderr)
        return error.exit_code


if __name__ == "__main__":
    sys.exit(main())
