"""The code that runs in the processes of workers."""

from __future__ import annotations

import asyncio
import filecmp
import os
import subprocess
import tempfile
import threading
import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from functools import lru_cache
from pathlib import Path
from typing import Any

from distributed import Reschedule, Worker, WorkerPlugin, get_worker

from corniche.child import Child, Ended, Usage
from corniche.errors import EXISTS, FAILED, INTERRUPTED, UNUSABLE, CornicheError, ProgramError
from corniche.program import find_program, version_of

from .errors import PartFailed
from .limits import Limits, limits_of
from .program import environment_of_child
from .tasks import PartResult, PartTask, Setting, is_object_storage, part_of_name

#: The child processes of each worker, by the worker's address.
_children: defaultdict[str, set[Child]] = defaultdict(set)
_lock = threading.Lock()
#: Seconds that children may take to end when their worker closes, before they are killed.
_CLOSES_WITHIN = 3.0
#: Part of the message of a merge while another process writes the same package.
_BEING_BUILT = "is being built by another process"
#: Seconds until the merge is tried again.
_TRIES_EVERY = 2.0
_NEVER_BEGUN = Ended(UNUSABLE, stdout="", log=[], seconds=0.0, usage=Usage(), was_stopped=False)


class PlanPlugin(WorkerPlugin):
    """Distributes a plan to every worker, including those that join later, and ends the processes of a worker that closes.

    The plugin stays registered after a build: another client may be building the same plan.
    """

    idempotent = True

    def __init__(self, plan: str, digest: str) -> None:
        self._plan = plan
        self._digest = digest
        self.name = f"corniche-plan-{digest}"

    def setup(self, worker: Worker) -> None:
        """Writes the plan to the worker's local folder, which Dask removes with the worker."""
        path = _plan_file(worker, self._digest)
        part = path.with_suffix(f".{os.getpid()}.new")
        part.write_text(self._plan, encoding="utf-8")
        part.replace(path)

    async def teardown(self, worker: Worker) -> None:
        """Ends the worker's child processes. If the worker is killed before, their pipes close anyway."""
        for child in _children_of(worker.address):
            child.stop()
        begun = time.monotonic()
        while _children_of(worker.address) and time.monotonic() - begun < _CLOSES_WITHIN:
            await asyncio.sleep(0.05)
        for child in _children_of(worker.address):
            child.kill()


def _children_of(worker: str) -> list[Child]:
    with _lock:
        return list(_children.get(worker, ()))


def _plan_file(worker: Worker, digest: str) -> Path:
    return Path(worker.local_directory) / f"corniche-plan-{digest}.json"


@lru_cache(maxsize=16)
def _program(asked: str | None, generator: str) -> str:
    """The path of the program, checked to have the version that created the plan."""
    program = find_program(asked)
    version = version_of(program)
    if version != generator:
        raise ProgramError(f"{program} is {version}, but the plan was created by {generator}")
    return program


def look_at_worker(setting: Setting, dask_worker: Worker) -> str | None:
    """The reason why this worker cannot build parts; ``None`` if it can."""
    try:
        _program(setting.program, setting.generator)
        _limits(dask_worker, setting)
    except CornicheError as error:
        return str(error)
    folders = [store for store in setting.stores if not is_object_storage(store)]
    missing = [folder for folder in folders if not os.path.isdir(folder)]
    if missing:
        return f"it does not see the folder {missing[0]}: a store must be a folder that all workers share, or s3://…"
    return None


def is_there(output: str) -> bool:
    """Whether a path exists, as this machine sees it."""
    return os.path.lexists(output)


def list_parts(setting: Setting, slots: int, least_work: float | None, with_store: bool) -> str:
    """The output of ``corniche jobs``, which with ``with_store`` also reads the stores."""
    worker = get_worker()
    command = [_program(setting.program, setting.generator), "jobs", str(_plan(worker, setting)), "--slots", str(slots)]
    if least_work is not None:
        command += ["--least-work", str(least_work)]
    if with_store:
        command += ["--store", *setting.stores]
    ran = subprocess.run(
        command,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        env=environment_of_child(),
        check=False,
    )
    if ran.returncode != 0:
        raise PartFailed(f"corniche jobs failed on {worker.address}, exit code {ran.returncode}:\n{ran.stderr.strip()}")
    return ran.stdout


def make_part(task: PartTask) -> PartResult:
    """Builds a part and returns its result.

    Raises ``PartFailed`` if another attempt may help. An error that would occur again is returned in the result.
    """
    worker = get_worker()
    setting, job = task.setting, task.job
    try:
        program = _program(setting.program, setting.generator)
        limits = _limits(worker, setting)
    except CornicheError as error:
        message = f"part {job.id} cannot be built on {worker.address}: {error}"
        return _result(task, worker, Limits(0, 0), _NEVER_BEGUN, exit_code=UNUSABLE, error=message)
    command = [program, "merge" if job.is_merge else "part", str(_plan(worker, setting)), *job.args, *_common(setting, limits)]
    if not job.is_merge:
        return _judged(task, worker, limits, _run(command, task, worker))
    overwrite = ["-O"] if setting.overwrite else []
    defects = ["--defects", setting.defects] if setting.defects else []
    merge = [*command, *overwrite, *defects, "-o", setting.output]
    while (ended := _run(merge, task, worker)).exit_code == FAILED and any(_BEING_BUILT in line for line in ended.log):
        # A worker that was wrongly thought to be dead runs the same merge. Its package is compared
        # below.
        time.sleep(_TRIES_EVERY)
    if ended.exit_code == EXISTS and not setting.overwrite and _is_same_package(command, task, worker):
        return _result(task, worker, limits, ended, name=setting.output, was_made=False)
    return _judged(task, worker, limits, ended)


def _is_same_package(merge: Sequence[str], task: PartTask, worker: Worker) -> bool:
    """Whether the existing package is the one that this merge would write.

    Dask may run a task twice, for example when a worker dies after the task ended. The package of the first run is then no error.
    """
    output = task.setting.output
    if is_object_storage(output) or not os.path.isfile(output):
        return False
    with tempfile.TemporaryDirectory(prefix=".corniche-", dir=os.path.dirname(output)) as folder:
        again = os.path.join(folder, "again.pmtiles")
        ended = _run([*merge, "-o", again], task, worker)
        return ended.exit_code == 0 and filecmp.cmp(again, output, shallow=False)


def _common(setting: Setting, limits: Limits) -> list[str]:
    options = ["--die-with-parent", "--json-progress", "--threads", str(limits.threads), "--memory", str(limits.memory_bytes)]
    if setting.tmp:
        options += ["--tmp", setting.tmp]
    return [*options, "--store", *setting.stores]


def _run(command: Sequence[str], task: PartTask, worker: Worker) -> Ended:
    """Runs a process to its end, or until Dask no longer wants the task."""
    child = Child(command, environment_of_child())
    with _registered(worker.address, child):
        ended = child.wait(lambda: _is_wanted(worker, task.key))
    if ended.was_stopped and ended.exit_code != 0:
        # If the task is still wanted after all, Dask submits it again; this is not a failure.
        raise Reschedule()
    return ended


@contextmanager
def _registered(worker: str, child: Child) -> Iterator[None]:
    with _lock:
        _children[worker].add(child)
    try:
        yield
    finally:
        with _lock:
            _children[worker].discard(child)


def _is_wanted(worker: Worker, key: str) -> bool:
    """Whether the task was neither cancelled nor released since it began. Dask does not notify a task in a thread."""
    state = worker.state.tasks.get(key)
    return state is not None and state.state != "cancelled"


def _judged(task: PartTask, worker: Worker, limits: Limits, ended: Ended) -> PartResult:
    job = task.job
    if ended.exit_code == 0:
        if job.is_merge:
            return _result(task, worker, limits, ended, name=task.setting.output, was_made=True)
        name, digest = part_of_name(ended.stdout)
        return _result(task, worker, limits, ended, name=name, digest=digest, was_made=name is not None)
    if ended.exit_code == INTERRUPTED:
        # All processes of the machine got a signal, so it may be about to be reclaimed. Another
        # worker resumes the part.
        time.sleep(_TRIES_EVERY)
        raise Reschedule()
    how = f"exit code {ended.exit_code}" if ended.exit_code > 0 else f"ended by signal {-ended.exit_code}"
    if ended.exit_code < 0 and ended.usage.peak_bytes is not None:
        how += f" when it used {ended.usage.peak_bytes >> 20} MiB of {limits.memory_bytes >> 20} MiB"
    log = "\n".join(f"    {line}" for line in ended.log)
    message = f"part {job.id} ({job.title()}) failed on {worker.address}: {how}; the last lines of its log:\n{log}"
    if ended.exit_code in (UNUSABLE, EXISTS):
        return _result(task, worker, limits, ended, exit_code=ended.exit_code, error=message)
    # The cause may be temporary: network file systems, for example, show files of other machines
    # with a delay.
    time.sleep(_TRIES_EVERY)
    raise PartFailed(message)


def _result(task: PartTask, worker: Worker, limits: Limits, ended: Ended, name: str | None = None, **told: Any) -> PartResult:
    return PartResult(
        id=task.job.id,
        step=task.job.step,
        work=task.job.work,
        name=name,
        file_bytes=_size(name if task.job.is_merge else ended.stdout.strip()) if name else None,
        worker=worker.address,
        seconds=ended.seconds,
        memory_bytes=limits.memory_bytes,
        threads=limits.threads,
        **asdict(ended.usage),
        **told,
    )


def _size(path: str) -> int | None:
    """The size of a file in bytes; ``None`` if this machine does not see the file."""
    try:
        return os.stat(path).st_size
    except OSError:
        return None


def _plan(worker: Worker, setting: Setting) -> Path:
    path = _plan_file(worker, setting.plan_digest)
    if not path.is_file():
        raise PartFailed(f"worker {worker.address} has no copy of the plan in {path.parent}; is its disk full?")
    return path


def _limits(worker: Worker, setting: Setting) -> Limits:
    return limits_of(
        worker.address,
        worker.state.nthreads,
        worker.memory_manager.memory_limit,
        worker.state.total_resources,
        setting.threads,
        setting.memory_bytes,
    )
