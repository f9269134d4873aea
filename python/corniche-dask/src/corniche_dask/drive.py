"""Submits parts to Dask and collects their results: as many at a time as there are slots, and the next part when one is finished.

Waiting parts are kept here and not in the scheduler. Therefore the largest go first, the scheduler's memory does not grow with the number of parts,
and no part waits behind a long one at a busy worker while another worker is idle.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from distributed import Client, Future, KilledWorker, as_completed

from corniche.errors import CornicheError

from .errors import PartsLost, SchedulerLost
from .flow import Flow
from .jobs import Job
from .limits import slots_of

Result = TypeVar("Result")

# : Dask gives up a task when some workers died while running it (``allowed-failures``), although
# their machines may just have been reclaimed. : A part is submitted again this often.
LOSSES = 20
#: Seconds between two queries for the number of slots.
SLOTS_EVERY = 5.0


class Slots:
    """The number of parts that the workers of a cluster run at once, which may change."""

    def __init__(self, client: Client, at_least: int = 1) -> None:
        self._client = client
        self._at_least = at_least
        self._asked: float | None = None
        self._count = 0
        self._are_declared = False

    def count(self) -> int:
        """The number of slots some seconds ago; never less than requested, so that a cluster that grows on demand sees the demand."""
        self._look()
        return max(self._count, self._at_least)

    @property
    def resources(self) -> dict[str, float] | None:
        """The resources of a worker that a part takes; ``None``: one of its threads."""
        self._look()
        return {"slot": 1} if self._are_declared else None

    def _look(self) -> None:
        now = time.monotonic()
        if self._asked is None or now - self._asked > SLOTS_EVERY:
            self._count, are_declared = slots_of(workers_of(self._client))
            # Never reset: workers that declare slots may leave for a while, and must not return to
            # more parts than they have slots.
            self._are_declared |= are_declared
            self._asked = now


def workers_of(client: Client) -> dict[str, Any]:
    """The scheduler's information about its workers, by address."""
    try:
        return dict(client.scheduler_info(n_workers=-1)["workers"])
    except OSError as error:
        raise lost(client) from error


def lost(client: Client) -> SchedulerLost:
    """The error for a lost scheduler."""
    address = client.scheduler.address if client.scheduler else "?"
    return SchedulerLost(f"the connection to the scheduler at {address} is lost; progress is saved in the store, repeat the command to resume")


@dataclass
class Drive(Generic[Result]):
    """Runs all parts of a flow."""

    client: Client
    flow: Flow
    #: Submits a part to the client.
    submit: Callable[[Job], Future[Any]]
    slots: Callable[[], int]
    #: Takes the result of a part; an exception from it ends the run.
    made: Callable[[Job, Result], None]
    #: Takes warnings.
    told: Callable[[str], None] = lambda _: None
    _losses: dict[str, int] = field(default_factory=dict)
    _jobs: dict[Future[Any], Job] = field(default_factory=dict)

    def run(self) -> None:
        """Returns when all parts are finished. If it raises, running parts are cancelled."""
        # The loop is given because the client may not be the default one.
        completed = as_completed(loop=self.client.loop, with_results=True, raise_errors=False)
        try:
            while not self.flow.is_over:
                while self.flow.at_work < self.slots() and (job := self.flow.take()) is not None:
                    future = self.submit(job)
                    self._jobs[future] = job
                    completed.add(future)
                if not self._jobs:
                    raise CornicheError("no part can be started, but not all are finished")
                for future, result in completed.next_batch():
                    self._take(completed, future, result)
        except BaseException:
            self._cancel()
            raise

    def _take(self, completed: as_completed, future: Future[Any], result: Any) -> None:
        job = self._jobs.pop(future)
        if future.status == "finished":
            self.flow.made(job)
            self.made(job, result)
            # Releases the key, so that a later build reads the store and not this result.
            future.release()
        elif future.status == "error":
            error = result[1] if isinstance(result, tuple) else result
            if not isinstance(error, KilledWorker):
                raise error
            self._give_out_again(completed, future, job, error)
        elif future.status in ("lost", "pending") and self.client.status == "running":
            # The worker with the result died at this moment. Dask runs the part again, which finds
            # its result in the store.
            self._jobs[future] = job
            completed.add(future)
        else:
            raise lost(self.client)

    def _give_out_again(self, completed: as_completed, future: Future[Any], job: Job, error: KilledWorker) -> None:
        losses = self._losses[job.id] = self._losses.get(job.id, 0) + 1
        if losses > LOSSES:
            raise PartsLost(f"giving up part {job.id}: workers died repeatedly while running it, most recently {error.last_worker}") from error
        self.told(f"workers died while running part {job.id}; submitting it again ({losses} of {LOSSES})")
        future.retry()
        self._jobs[future] = job
        completed.add(future)

    def _cancel(self) -> None:
        futures = list(self._jobs)
        self._jobs.clear()
        if futures and self.client.status == "running":
            try:
                self.client.cancel(futures)
            except Exception as error:  # noqa: BLE001  the error that ended the run is the one to report
                self.told(f"running parts could not be cancelled: {error!r}")
