"""The command ``corniche-dask``."""

from __future__ import annotations

import argparse
import importlib.util
import json
import logging
import os
import signal
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any, NoReturn

from distributed import Client

from corniche.errors import FAILED, INTERRUPTED, CornicheError, TargetExists, UsageError
from corniche.program import find_program

from . import cost
from .build import build
from .errors import SchedulerLost
from .limits import parse_bytes
from .local import local_cluster
from .program import make_plan
from .progress import Progress
from .tasks import absolute, is_object_storage


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command; returns an exit code with the same meaning as that of ``corniche``."""
    given, rest = _parser().parse_known_args(arguments)
    try:
        if given.command == "cost":
            if rest:
                raise UsageError(f"{rest[0]}: not an option of corniche-dask cost")
            print(cost.run(given.runs, given.target, given.storage, given.price))
            return 0
        return _build(given, rest)
    except CornicheError as error:
        print(f"corniche-dask: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print("corniche-dask: interrupted; progress is saved in the store, repeat the command to resume", file=sys.stderr)
        return INTERRUPTED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="corniche-dask", description="Distributes Corniche builds over the workers of a Dask cluster.", allow_abbrev=False
    )
    commands = parser.add_subparsers(dest="command", required=True)
    _add_build(commands)
    cost.add_command(commands)
    return parser


def _add_build(commands: Any) -> None:
    build_parser = commands.add_parser(
        "build",
        allow_abbrev=False,
        help="build a tile package on the workers of a cluster",
        description="Builds a tile package on the workers of a cluster: the same bytes as corniche build. After any failure, repeat the "
        "command to resume. Options not listed here are passed to corniche plan: --dem, --osm, --max-error and all others.",
    )
    add = build_parser.add_argument
    cluster = build_parser.add_mutually_exclusive_group(required=True)
    cluster.add_argument("--scheduler", metavar="ADDRESS", help="the scheduler of a cluster, such as tcp://10.0.0.1:8786")
    cluster.add_argument("--scheduler-file", metavar="JSON", help="the file in which a scheduler wrote its address")
    cluster.add_argument("--local", metavar="N", type=_count, help="start N workers on this machine, each of which builds one part at a time")
    add("--threads-per-worker", metavar="T", type=_count, help="with --local: threads of each worker [default: the processors, divided by N]")
    add("--memory-limit", metavar="BYTES", type=_bytes, help="with --local: memory of each worker [default: 3/4 of the machine's, divided by N]")
    add("--plan", metavar="PLAN.json", help="build this plan; replaces the options of corniche plan")
    add("--store", metavar="STORE", nargs="+", required=True, help="a folder that all workers share, or s3://BUCKET/PREFIX; the first is written to")
    add("-o", "--output", metavar="PACKAGE", required=True, help="the package to write, as the workers see it")
    add("-O", "--overwrite", action="store_true", help="overwrite the package if it exists")
    add("--defects", metavar="CSV", help="also list every defect of the extract and every lost road in this file")
    add(
        "--slots",
        metavar="N",
        type=_count,
        help="submit at least N parts at once, for clusters that grow on demand [default: what the workers run at once]",
    )
    add("--least-work", metavar="SECONDS", type=float, help="avoid parts smaller than this, in estimated seconds on one core")
    add("--threads", metavar="N", type=_count, help="threads of each process [default: the worker's threads, divided by its slots]")
    add("--memory", metavar="BYTES", type=_bytes, help="memory limit of each process [default: the worker's memory, divided by its slots]")
    add("--tmp", metavar="FOLDER", help="folder in which parts are created before they are uploaded to a store in object storage")
    add(
        "--corniche",
        metavar="PROGRAM",
        help="the program corniche, on this machine and all workers [default: $CORNICHE, the one in the Python package corniche, or the one on PATH]",
    )
    add("--report", metavar="JSON", help="write time, memory and bytes of each part, for corniche-dask cost; an existing file is overwritten")
    add("-q", "--quiet", action="store_true", help="print only errors and warnings")


def _count(text: str) -> int:
    value = int(text)
    if value < 1:
        raise ValueError(text)
    return value


def _bytes(text: str) -> int:
    try:
        return parse_bytes(text)
    except UsageError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _build(given: argparse.Namespace, plan_options: list[str]) -> int:
    _check(given, plan_options)
    signal.signal(signal.SIGTERM, _end)
    progress = Progress(quiet=given.quiet)
    with tempfile.TemporaryDirectory(prefix="corniche-dask-") as folder:
        plan, estimate = given.plan, None
        if plan is None:
            plan = Path(folder) / "plan.json"
            estimate = make_plan(find_program(given.corniche), plan_options, plan)
        with _client(given) as client:
            if not given.quiet and client.dashboard_link and importlib.util.find_spec("bokeh"):
                print(f"dashboard: {client.dashboard_link}", file=sys.stderr)
            summary = build(
                client,
                plan,
                given.store,
                given.output,
                memory_bytes=given.memory,
                estimate=estimate,
                progress=progress,
                **{name: getattr(given, name) for name in ("overwrite", "defects", "corniche", "slots", "least_work", "threads", "tmp")},
            )
    if given.report:
        Path(given.report).write_text(json.dumps(summary.to_json(), indent=1) + "\n", encoding="utf-8")
    if not given.quiet:
        print(f"\n{summary.to_text()}\n\nwrote {summary.package} in {summary.seconds:.1f} s", file=sys.stderr)
    above = summary.above_memory()
    for text in above:
        print(f"corniche-dask: error: {text}; the package is complete, but other machines may run out of memory", file=sys.stderr)
    return FAILED if above else 0


def _check(given: argparse.Namespace, plan_options: list[str]) -> None:
    if given.plan and plan_options:
        raise UsageError(f"{plan_options[0]} is an option of corniche plan, but --plan gives a finished plan; omit one of the two")
    if not given.plan and not plan_options:
        raise UsageError("there is nothing to build: give options of corniche plan, such as --dem FILE, or --plan PLAN.json")
    if given.local is None and (given.threads_per_worker or given.memory_limit):
        raise UsageError("--threads-per-worker and --memory-limit need --local; other workers keep the settings with which they were started")
    output = absolute(given.output)
    # If this machine sees the output, an existing one is reported before planning; the workers
    # check again.
    if not is_object_storage(output) and not given.overwrite and os.path.lexists(output):
        raise TargetExists(f"{given.output} exists; pass -O to overwrite it")


def _end(_: int, __: FrameType | None) -> NoReturn:
    """Treats SIGTERM like Ctrl-C: running parts are cancelled."""
    raise KeyboardInterrupt


@contextmanager
def _client(given: argparse.Namespace) -> Iterator[Client]:
    if given.local is None:
        # This command reports a lost scheduler in one line, instead of Dask's tracebacks.
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        if given.scheduler_file and not os.path.exists(given.scheduler_file):
            print(f"waiting for a scheduler to write {given.scheduler_file}", file=sys.stderr)
        try:
            client = Client(scheduler_file=given.scheduler_file) if given.scheduler_file else Client(given.scheduler)
        except (OSError, ValueError) as error:
            raise SchedulerLost(f"no scheduler responds at {given.scheduler or given.scheduler_file}: {error}") from error
        with client:
            yield client
        return
    with local_cluster(given.local, given.threads_per_worker, given.memory_limit) as cluster, Client(cluster) as client:
        yield client


if __name__ == "__main__":
    sys.exit(main())
