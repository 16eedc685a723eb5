#!/usr/bin/env python3
"""Prints what Google Benchmark measured as ratios, which say more than times of one machine.

usage: ratios.py FILE.json...

Benchmarks whose names agree up to the first slash are one group; each row tells its time, by HIP where the
benchmark counts them, and its ratio to the first row of the group. Exit code 1 if a benchmark failed.
"""

import json
import sys

NANOSECONDS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}


def time_of(run):
    """ns of CPU of one HIP, or of one iteration where HIPs are not counted."""
    if "ns_per_hip" in run:
        return run["ns_per_hip"]
    return run["cpu_time"] * NANOSECONDS[run["time_unit"]]


def rows_of(runs):
    """(name, ns, ratio) of each run that is one measurement, and the names of those that failed."""
    rows, failed, first = [], [], {}
    for run in runs:
        if run.get("error_occurred"):
            failed.append(f"{run['name']}: {run['error_message']}")
        elif run.get("run_type") == "iteration":
            nanoseconds = time_of(run)
            base = first.setdefault(run["name"].split("/")[0], nanoseconds)
            rows.append((run["name"], nanoseconds, nanoseconds / base if base > 0.0 else float("nan")))
    return rows, failed


def main(paths):
    if not paths:
        print(__doc__, file=sys.stderr)
        return 64
    runs = []
    for path in paths:
        with open(path, encoding="utf-8") as file:
            runs += json.load(file)["benchmarks"]
    rows, failed = rows_of(runs)
    width = max((len(name) for name, _, _ in rows), default=0)
    print(f"{'':{width}}  {'ns':>12}  {'ratio':>8}")
    for name, nanoseconds, ratio in rows:
        print(f"{name:{width}}  {nanoseconds:12.1f}  {ratio:8.2f}")
    for failure in failed:
        print(f"failed: {failure}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
