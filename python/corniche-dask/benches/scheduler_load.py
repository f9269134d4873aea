"""The load of many small parts on the scheduler: they run through the same code as parts of a build, but produce nothing.

    python benches/scheduler_load.py --parts 100000 --slots 256

Starts a scheduler and workers as separate processes, and prints parts per second, and the scheduler's memory and processor time, as Markdown.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from distributed import Client, Future

from corniche.child import peak_memory
from corniche_dask.drive import Drive
from corniche_dask.flow import Flow
from corniche_dask.jobs import Job
from corniche_dask.tasks import PartResult, PartTask, Setting, key_of

SETTING = Setting("0" * 64, "corniche 0", None, ("/store",), None, None, None, "/package.pmtiles", False, None)


def empty_part(task: PartTask) -> PartResult:
    """Returns a digest, like a part of a build."""
    digest = task.key[-32:]
    return PartResult(
        id=task.job.id,
        step=task.job.step,
        work=task.job.work,
        was_made=True,
        name=f"{task.job.id}.{digest}.part",
        digest=digest,
        file_bytes=0,
        worker="",
        seconds=0,
        cpu_seconds=0,
        read_bytes=0,
        written_bytes=0,
        peak_bytes=0,
        memory_bytes=1 << 30,
        threads=1,
    )


def jobs(parts: int) -> list[Job]:
    """The parts: half heights, half tiles, with one part between them and one at the end."""

    def of(step: str, number: int, *after: str) -> Job:
        return Job(f"{step}-{number}", step, f"20/{number}/0", None, 1.0 + number % 7, after, ("--step", step, "--subtree", f"20/{number}/0"))

    listed = [of("heights", number) for number in range(parts // 2)]
    listed.append(of("top", 0, "heights"))
    listed += [of("tiles", number, "top") for number in range(parts - parts // 2 - 2)]
    return [*listed, Job("merge", "merge", None, None, 1.0, ("tiles",), ())]


@contextmanager
def cluster(workers: int, threads: int) -> Iterator[tuple[str, int]]:
    """Starts a scheduler with workers; yields its address and process id."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scheduler.json"
        dask = [sys.executable, "-m", "dask"]
        # By name, like parts of a build, so that no code is sent over the network.
        environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent)}
        quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": folder, "env": environment}
        begun = [subprocess.Popen([*dask, "scheduler", "--scheduler-file", str(file), "--port", "0", "--no-dashboard"], **quiet)]
        try:
            for _ in range(workers):
                options = ["--nthreads", str(threads), "--no-nanny", "--no-dashboard", "--local-directory", folder]
                begun.append(subprocess.Popen([*dask, "worker", "--scheduler-file", str(file), *options], **quiet))
            yield str(file), begun[0].pid
        finally:
            for process in reversed(begun):
                process.terminate()
            for process in begun:
                process.wait()


def processor_seconds(pid: int) -> float:
    """The user and system time of a running process, in seconds."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main() -> None:
    """Runs the measurement and prints the result."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--parts", type=int, default=100_000)
    parser.add_argument("--slots", type=int, default=256, help="parts that are handed out at once")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    parser.add_argument("--threads", type=int, default=8, help="threads of each of them")
    given = parser.parse_args()
    with cluster(given.workers, given.threads) as (file, scheduler), Client(scheduler_file=file) as client:
        client.wait_for_workers(given.workers)
        before, seconds_before = peak_memory(scheduler) or 0, processor_seconds(scheduler)
        flow = Flow(jobs(given.parts))
        made: list[PartResult] = []

        def submit(job: Job) -> Future[Any]:
            task = PartTask(key_of(SETTING, job), job, SETTING)
            return client.submit(empty_part, task, key=task.key, pure=True, retries=3, priority=int(flow.rank(job)))

        begun = time.monotonic()
        Drive(client, flow, submit, lambda: given.slots, lambda _, result: made.append(result)).run()
        took = time.monotonic() - begun
        assert len(made) == given.parts, f"{len(made)} of {given.parts} parts were made"
        used = processor_seconds(scheduler) - seconds_before
        peak = peak_memory(scheduler) or 0
        left = client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks))
    own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print("| parts | at once | time | parts/s | scheduler: processor | a part | memory before | at most | tasks left | client's memory |")
    print("| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    print(
        f"| {given.parts} | {given.slots} | {took:.1f} s | {given.parts / took:.0f} | {used:.1f} s | {1000 * used / given.parts:.2f} ms | "
        f"{before / 2**20:.0f} MiB | {peak / 2**20:.0f} MiB | {left} | {own:.0f} MiB |"
    )


if __name__ == "__main__":
    # The name under which workers import this module.
    import scheduler_load

    scheduler_load.main()
