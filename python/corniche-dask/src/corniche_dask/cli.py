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
    """Runs the command; returns its exit code, which means what that of ``corniche`` means."""
    given, rest = _parser().parse_known_args(arguments)
    try:
        if given.command == "cost":
            if rest:
                raise UsageError(f"{rest[0]}: corniche-dask cost has no such option")
            print(cost.run(given.runs, given.target, given.storage, given.price))
            return 0
        return _build(given, rest)
    except CornicheError as error:
        print(f"corniche-dask: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print("corniche-dask: interrupted; the same command goes on from what is in the store", file=sys.stderr)
        return INTERRUPTED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="corniche-dask", description="Builds of Corniche, spread over the workers of a Dask cluster.", allow_abbrev=False
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
        description="Builds a tile package on the workers of a cluster: the same bytes as corniche build. The same command goes on after "
        "anything was lost. Options that are not listed here go to corniche plan: --dem, --osm, --max-error and all others.",
    )
    add = build_parser.add_argument
    cluster = build_parser.add_mutually_exclusive_group(required=True)
    cluster.add_argument("--scheduler", metavar="ADDRESS", help="the scheduler of a cluster, such as tcp://10.0.0.1:8786")
    cluster.add_argument("--scheduler-file", metavar="JSON", help="the file in which a scheduler left its address")
    cluster.add_argument("--local", metavar="N", type=_count, help="start N workers on this machine, which make one part at a time each")
    add("--threads-per-worker", metavar="T", type=_count, help="with --local [default: the processors, divided by N]")
    add("--memory-limit", metavar="BYTES", type=_bytes, help="with --local: memory of each worker [default: its share of the machine's]")
    add("--plan", metavar="PLAN.json", help="build this plan, in place of options of corniche plan")
    add("--store", metavar="STORE", nargs="+", required=True, help="a folder that all workers share, or s3://BUCKET/PREFIX; the first is written")
    add("-o", "--output", metavar="PACKAGE", required=True, help="the package to write, as the workers see it")
    add("-O", "--overwrite", action="store_true", help="replace the package if it exists")
    add("--defects", metavar="CSV", help="also list every defect of the extract and every road lost")
    add(
        "--slots",
        metavar="N",
        type=_count,
        help="hand out at least N parts at once, for clusters that grow by demand [default: what workers make]",
    )
    add("--least-work", metavar="SECONDS", type=float, help="make no part smaller than this without need, in estimated seconds on one core")
    add("--threads", metavar="N", type=_count, help="threads of each process [default: the worker's, divided by its slots]")
    add("--memory", metavar="BYTES", type=_bytes, help="the most memory of each process [default: the worker's, divided by its slots]")
    add("--tmp", metavar="FOLDER", help="where parts are made before they are uploaded to a store in object storage")
    add(
        "--corniche",
        metavar="PROGRAM",
        help="the program corniche, on this machine and all workers [default: $CORNICHE, that of the package corniche, or the one on PATH]",
    )
    add("--report", metavar="JSON", help="write what each part took, for corniche-dask cost; an existing file is replaced")
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
                overwrite=given.overwrite,
                defects=given.defects,
                corniche=given.corniche,
                slots=given.slots,
                least_work=given.least_work,
                threads=given.threads,
                memory_bytes=given.memory,
                tmp=given.tmp,
                estimate=estimate,
                progress=progress,
            )
    if given.report:
        Path(given.report).write_text(json.dumps(summary.to_json(), indent=1) + "\n", encoding="utf-8")
    if not given.quiet:
        print(f"\n{summary.to_text()}\n\nwrote {summary.package} in {summary.seconds:.1f} s", file=sys.stderr)
    above = summary.above_memory()
    for text in above:
        print(f"corniche-dask: error: {text}; the package is complete, but a machine may have no memory to spare", file=sys.stderr)
    return FAILED if above else 0


def _check(given: argparse.Namespace, plan_options: list[str]) -> None:
    if given.plan and plan_options:
        raise UsageError(f"{plan_options[0]} belongs to a plan that is to be made; with --plan it is made already")
    if not given.plan and not plan_options:
        raise UsageError("there is nothing to build: give options of corniche plan, such as --dem FILE, or --plan PLAN.json")
    if given.local is None and (given.threads_per_worker or given.memory_limit):
        raise UsageError("--threads-per-worker and --memory-limit are for --local; other workers have what they were started with")
    output = absolute(given.output)
    # What this machine can see is told before anything is planned; the workers look again.
    if not is_object_storage(output) and not given.overwrite and os.path.lexists(output):
        raise TargetExists(f"{given.output} exists; -O replaces it")


def _end(_: int, __: FrameType | None) -> NoReturn:
    """A signal to end is answered like Ctrl-C: parts that are being made are cancelled."""
    raise KeyboardInterrupt


@contextmanager
def _client(given: argparse.Namespace) -> Iterator[Client]:
    if given.local is None:
        # A scheduler that is lost is told by this command, in one line instead of Dask's tracebacks.
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        if given.scheduler_file and not os.path.exists(given.scheduler_file):
            print(f"waiting for a scheduler to write {given.scheduler_file}", file=sys.stderr)
        try:
            client = Client(scheduler_file=given.scheduler_file) if given.scheduler_file else Client(given.scheduler)
        except (OSError, ValueError) as error:
            raise SchedulerLost(f"no scheduler answers at {given.scheduler or given.scheduler_file}: {error}") from error
        with client:
            yield client
        return
    with local_cluster(given.local, given.threads_per_worker, given.memory_limit) as cluster, Client(cluster) as client:
        yield client


if __name__ == "__main__":
    sys.exit(main())
