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

#: So often Dask tries a part that failed.
RETRIES = 3
#: The step whose parts are asked for again when it begins: then the roads of each subtree are known.
_REFINED = "tiles"
#: How often it is looked whether a worker has come, in seconds.
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
    """Makes the package of a plan on the workers of ``client``: the same bytes as ``corniche build``.

    All state is in the store: when this call ends early, for any reason, the same call goes on from there.

    :param client: a client that is not asynchronous
    :param plan: path of the plan that ``corniche plan -o`` wrote; this process reads it
    :param store: a folder that all workers share, or ``s3://BUCKET/PREFIX``; of several, the first is written and all are read
    :param output: the package, as the workers see it
    :param overwrite: replace the package if it exists
    :param defects: also list every defect and every road lost in this file
    :param corniche: the program on every worker; ``None``: each looks at ``$CORNICHE`` and ``PATH``
    :param slots: at least so many parts are handed out at once, and parts are sized for so many; ``None``: as many as the workers that are there make
    :param least_work: make no part smaller than this without need, in estimated seconds on one core; ``None``: what ``corniche jobs`` chooses
    :param threads: threads of each process; ``None``: those of the worker, divided by its slots
    :param memory_bytes: the most memory of each process; ``None``: that of the worker, divided by its slots
    :param tmp: where parts are made before they are uploaded, on every worker
    :param estimate: what ``corniche plan --json`` told, for the summary
    :param progress: what tells how far it is; ``None``: nothing is told
    :raises CornicheError: with a text for the user; its ``exit_code`` is that of the command
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
        """Makes the folder that is written. Where this machine cannot, because only workers see it, they say if it is missing."""
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
                self.progress.say("waiting for a first worker")
                is_told = True
            time.sleep(_LOOKS_EVERY)

    def _look_at_workers(self) -> None:
        """Before anything is made: whether all workers can make parts, and whether the package may be written."""
        wrong: dict[str, Any] = self.client.run(look_at_worker, self.setting, on_error="return")
        lines = [f"  {worker}: {why}" for worker, why in sorted(wrong.items()) if why is not None]
        if lines:
            raise ProgramError("\n".join(["not all workers can make parts of this plan:", *lines]))
        output = self.setting.output
        if self.setting.overwrite or is_object_storage(output):
            return
        if any(self.client.run(is_there, output, workers=[min(wrong)]).values()):
            raise TargetExists(f"{output} exists; -O replaces it")


def _read(plan: str | os.PathLike[str]) -> str:
    try:
        return Path(plan).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"cannot read the plan {os.fspath(plan)}: {error}") from error


def _input_bytes(plan: str) -> dict[str, int]:
    """Bytes of all inputs of each kind."""
    kinds: dict[str, int] = {}
    for planned in json.loads(plan).get("inputs", []):
        kinds[str(planned["kind"])] = kinds.get(str(planned["kind"]), 0) + int(planned["bytes"])
    return kinds
