"""Compares a cluster with one process with as many threads: both build the same package, in turn.

    python benches/efficiency.py --workers 2 --rounds 3 --work FOLDER --dem DEM.tif --osm ROADS.osm.pbf …

Options not listed here are passed to ``corniche plan`` and ``corniche build``. Prints Markdown, and fails if the packages differ. The last report of
the cluster stays in the folder, for ``corniche-dask cost``.
"""

from __future__ import annotations

import argparse
import filecmp
import resource
import shutil
import statistics
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from corniche.program import find_program
from corniche_dask.limits import parse_bytes


def timed(command: Sequence[str]) -> tuple[float, float]:
    """The wall time and the processor time of a command with all its processes, in seconds."""
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run(command, check=True, stdin=subprocess.DEVNULL)
    wall, after = time.monotonic() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Runs the measurement and prints the result."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--memory", default="1G", help="of each worker; one process has as much as all of them")
    parser.add_argument("--work", type=Path, required=True, help="a folder, made if it is not there; a build in it is replaced")
    given, inputs = parser.parse_known_args()
    program = find_program(None)
    given.work.mkdir(parents=True, exist_ok=True)
    one, spread, store = (given.work / name for name in ["one.pmtiles", "spread.pmtiles", "store"])
    memory_bytes = str(given.workers * parse_bytes(given.memory))
    build = [program, "build", "-q", "-O", "--threads", str(given.workers), "--memory", memory_bytes]
    build += [*inputs, "--tmp", str(given.work), "-o", str(one)]
    cluster = [sys.executable, "-m", "corniche_dask", "build", "-q", "-O", "--local", str(given.workers), "--threads-per-worker", "1"]
    cluster += ["--memory", given.memory, *inputs, "--report", str(given.work / "report.json"), "--store", str(store), "-o", str(spread)]
    print("| round | one process, s | CPU, s | workers, s | CPU, s | efficiency | CPU, one process / workers |")
    print("| ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    ratios = []
    for number_of_round in range(1, given.rounds + 1):
        shutil.rmtree(store, ignore_errors=True)
        alone, alone_cpu = timed(build)
        together, together_cpu = timed(cluster)
        if not filecmp.cmp(one, spread, shallow=False):
            raise SystemExit(f"the packages differ: {one}, {spread}")
        ratios.append((alone / together, alone_cpu / together_cpu))
        row = [f"{number_of_round}", *(f"{seconds:.1f}" for seconds in [alone, alone_cpu, together, together_cpu])]
        print("| " + " | ".join(row + [f"{100 * ratio:.0f} %" for ratio in ratios[-1]]) + " |", flush=True)
    medians = [statistics.median(ratio) for ratio in zip(*ratios, strict=True)]
    print("| median | | | | | " + " | ".join(f"{100 * median:.0f} %" for median in medians) + " |")


if __name__ == "__main__":
    main()
