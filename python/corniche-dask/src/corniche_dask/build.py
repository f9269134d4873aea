"""A build on the workers of a Dask cluster."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from distributed import Client, Future

from corniche.errors import CornicheError, ProgramError, TargetExists, UsageError

from .drive import Drive, Slots, lost, workers_of
from .errors import PartFailed, PartRefused
from .flow import Flow
from .jobs import Job, parse_jobs
from .program import generator_of
from .progress import Progress
from .summary import Summary
from .tasks import PartResult, PartTask, Setting, absolute, digest_of, is_object_storage, key_of, stores_of
from .worker import PlanPlugin, is_there, list_parts, look_at_worker, make_part

#: How often Dask retries a part that failed.
RETRIES = 3
# : The step whose parts are listed again when it begins, because the roads of each subtree are
# known only then.
_REFINED = "tiles"
#: Seconds between two checks of whether a worker has joined.
_LOOKS_EVERY = 0.2


def build(
    client: Client,
    plan: str | os.PathLike[str],
    store: str | Sequence[str],
    output: str,
    *,
    overwrite: bool = False,
    defects: str | None = None,
    corniche: str | None = None,
    slots: int | None = None,
    least_work: float | None = None,
    threads: int | None = None,
    memory_bytes: int | None = None,
    tmp: str | None = None,
    estimate: dict[str, Any] | None = None,
    progress: Progress | None = None,
) -> Summary:
    """Builds the package of a plan on the workers of ``client``: the same bytes as ``corniche build``.

    All state is in the store: if this call ends early for any reason, repeat it to resume.

    :param client: a client that is not asynchronous
    :param plan: path of the plan that ``corniche plan -o`` wrote, on this machine
    :param store: a folder that all workers share, or ``s3://BUCKET/PREFIX``; if there are several, parts are written to the first and read from all
    :param output: path of the package, as the workers see it
    :param overwrite: overwrite the package if it exists
    :param defects: also list every defect of the extract and every lost road in this file
    :param corniche: path of the program on every worker; ``None``: each uses ``$CORNICHE`` or ``PATH``
    :param slots: the least number of parts at once, for which parts are sized; ``None``: what the current workers run at once
    :param least_work: avoid parts smaller than this, in estimated seconds on one core; ``None``: the default of ``corniche jobs``
    :param threads: threads of each process; ``None``: the worker's threads, divided by its slots
    :param memory_bytes: memory limit of each process; ``None``: the worker's memory, divided by its slots
    :param tmp: folder on every worker in which parts are created before they are uploaded
    :param estimate: the estimate of ``corniche plan --json``, for the summary
    :param progress: reports progress; ``None``: no progress is reported
    :raises CornicheError: with a message for the user; its ``exit_code`` is the exit code of the command
    """
    if client.asynchronous:
        raise UsageError("build() needs a client that is not asynchronous")
    progress = progress or Progress(quiet=True)
    text = _read(plan)
    setting = Setting(
        plan_digest=digest_of(text),
        generator=generator_of(text),
        program=corniche,
        stores=stores_of(store),
        tmp=absolute(tmp) if tmp else None,
        threads=threads,
        memory_bytes=memory_bytes,
        output=absolute(output),
        overwrite=overwrite,
        defects=absolute(defects) if defects else None,
    )
    return _Build(client, setting, text, least_work, progress, Slots(client, slots or 1)).run(estimate)


@dataclass
class _Build:
    client: Client
    setting: Setting
    plan: str
    least_work: float | None
    progress: Progress
    slots: Slots
    has_roads: bool = False

    def run(self, estimate: dict[str, Any] | None) -> Summary:
        begun = time.monotonic()
        self._make_folders()
        self._wait_for_worker()
        self._look_at_workers()
        plugin = PlanPlugin(self.plan, self.setting.plan_digest)
        self.client.register_plugin(plugin, name=plugin.name)
        summary = Summary(self.setting.output, slots=self.slots.count(), estimate=estimate, input_bytes=_input_bytes(self.plan))
        flow = Flow(self._parts(with_store=False), self._refine)

        def made(job: Job, result: PartResult) -> None:
            if result.error is not None:
                raise PartRefused(result.error, result.exit_code)
            summary.parts.append(result)
            self.progress.made(job)

        drive: Drive[PartResult] = Drive(
            self.client,
            flow,
            lambda job: self._submit(job, flow),
            self.slots.count,
            made,
            self.progress.say,
        )
        self.progress.begin(flow)
        try:
            drive.run()
        finally:
            self.progress.end()
        summary.seconds = time.monotonic() - begun
        return summary

    def _submit(self, job: Job, flow: Flow) -> Future[Any]:
        task = PartTask(key_of(self.setting, job), job, self.setting)
        return self.client.submit(
            make_part,
            task,
            key=task.key,
            pure=True,
            retries=RETRIES,
            priority=int(flow.rank(job)),
            resources=self.slots.resources,
        )

    def _refine(self, step: str) -> list[Job] | None:
        if step != _REFINED or not self.has_roads:
            return None
        return [job for job in self._parts(with_store=True) if job.step == step]

    def _parts(self, with_store: bool) -> list[Job]:
        count = self.slots.count()
        content = json.dumps([self.setting.plan_digest, self.setting.stores, count, self.least_work, with_store])
        key = f"jobs-0{digest_of(content)[:32]}"
        future = self.client.submit(list_parts, self.setting, count, self.least_work, with_store, key=key, pure=True, retries=RETRIES)
        try:
            jobs = parse_jobs(str(future.result()))
        except CornicheError:
            raise
        except Exception as error:
            raise (lost(self.client) if future.status in ("cancelled", "lost") else PartFailed(f"corniche jobs: {error!r}")) from error
        finally:
            future.release()
        self.has_roads = any(job.step == "roads" for job in jobs)
        return jobs

    def _make_folders(self) -> None:
        """Creates the first store's folder. If only the workers see this folder, they report it if it is missing."""
        first = self.setting.stores[0]
        if not is_object_storage(first):
            try:
                Path(first).mkdir(parents=True, exist_ok=True)
            except OSError:
                pass

    def _wait_for_worker(self) -> None:
        is_told = False
        while not workers_of(self.client):
            if self.client.status not in ("running", "connecting"):
                raise lost(self.client)
            if not is_told:
                self.progress.say("waiting for the first worker")
                is_told = True
            time.sleep(_LOOKS_EVERY)

    def _look_at_workers(self) -> None:
        """Checks, before any part is built, that all workers can build parts and that the package may be written."""
        wrong: dict[str, Any] = self.client.run(look_at_worker, self.setting, on_error="return")
        lines = [f"  {worker}: {why}" for worker, why in sorted(wrong.items()) if why is not None]
        if lines:
            raise ProgramError("\n".join(["not all workers can build parts of this plan:", *lines]))
        output = self.setting.output
        if self.setting.overwrite or is_object_storage(output):
            return
        if any(self.client.run(is_there, output, workers=[min(wrong)]).values()):
            raise TargetExists(f"{output} exists; pass -O to overwrite it")


def _read(plan: str | os.PathLike[str]) -> str:
    try:
        return Path(plan).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"cannot read the plan {os.fspath(plan)}: {error}") from error


def _input_bytes(plan: str) -> dict[str, int]:
    """The bytes of the inputs, by kind."""
    kinds: dict[str, int] = {}
    for planned in json.loads(plan).get("inputs", []):
        kinds[str(planned["kind"])] = kinds.get(str(planned["kind"]), 0) + int(planned["bytes"])
    return kinds
