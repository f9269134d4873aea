"""Hands out parts to Dask and takes their results: as many at a time as there are slots, the next one when one is made.

Parts that wait are kept here and not at the scheduler. So the largest go first, the scheduler's memory does not grow with the number of parts,
and no part waits behind a long one at a busy worker while another worker has nothing to do.
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

#: Dask gives a task up when so many workers died with it (``allowed-failures``), though machines may just have been taken away. It is given
#: out again so often.
LOSSES = 20
#: How often it is asked how many slots there are, in seconds.
SLOTS_EVERY = 5.0


class Slots:
    """How many parts the workers of a cluster make at once. It may change."""

    def __init__(self, client: Client, at_least: int = 1) -> None:
        self._client = client
        self._at_least = at_least
        self._asked: float | None = None
        self._count = 0
        self._are_declared = False

    def count(self) -> int:
        """As it was at most some seconds ago; never less than asked for, so that a cluster that grows by demand sees the demand."""
        self._look()
        return max(self._count, self._at_least)

    @property
    def resources(self) -> dict[str, float] | None:
        """What a part takes of a worker's resources; ``None``: one of its threads."""
        self._look()
        return {"slot": 1} if self._are_declared else None

    def _look(self) -> None:
        now = time.monotonic()
        if self._asked is None or now - self._asked > SLOTS_EVERY:
            self._count, are_declared = slots_of(workers_of(self._client))
            # Once for all: workers that declare slots may be away for a while, and must not come back to more parts than they have slots.
            self._are_declared |= are_declared
            self._asked = now


def workers_of(client: Client) -> dict[str, Any]:
    """What the scheduler tells of its workers, by their addresses."""
    try:
        return dict(client.scheduler_info(n_workers=-1)["workers"])
    except OSError as error:
        raise lost(client) from error


def lost(client: Client) -> SchedulerLost:
    """The error when the scheduler is gone."""
    address = client.scheduler.address if client.scheduler else "?"
    return SchedulerLost(f"the scheduler at {address} is gone; what was made is in the store, and the same command goes on from there")


@dataclass
class Drive(Generic[Result]):
    """Makes all parts of a flow."""

    client: Client
    flow: Flow
    #: Gives a part to the client.
    submit: Callable[[Job], Future[Any]]
    slots: Callable[[], int]
    #: Takes a part's result, and ends all by raising.
    made: Callable[[Job, Result], None]
    #: Takes warnings.
    told: Callable[[str], None] = lambda _: None
    _losses: dict[str, int] = field(default_factory=dict)
    _jobs: dict[Future[Any], Job] = field(default_factory=dict)

    def run(self) -> None:
        """Returns when all parts are made. When it raises, the parts that are being made are cancelled."""
        # Loops are named for clients that are not the default one.
        completed = as_completed(loop=self.client.loop, with_results=True, raise_errors=False)
        try:
            while not self.flow.is_over:
                while self.flow.at_work < self.slots() and (job := self.flow.take()) is not None:
                    future = self.submit(job)
                    self._jobs[future] = job
                    completed.add(future)
                if not self._jobs:
                    raise CornicheError("no part can be made, and yet not all are")
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
            # The key is forgotten, so that a later build asks the store and not this result.
            future.release()
        elif future.status == "error":
            error = result[1] if isinstance(result, tuple) else result
            if not isinstance(error, KilledWorker):
                raise error
            self._give_out_again(completed, future, job, error)
        elif future.status in ("lost", "pending") and self.client.status == "running":
            # The worker with the result died at this moment. Dask makes the part again, which finds it in the store.
            self._jobs[future] = job
            completed.add(future)
        else:
            raise lost(self.client)

    def _give_out_again(self, completed: as_completed, future: Future[Any], job: Job, error: KilledWorker) -> None:
        losses = self._losses[job.id] = self._losses.get(job.id, 0) + 1
        if losses > LOSSES:
            raise PartsLost(f"part {job.id} was given up: workers died with it again and again, {error.last_worker} the last") from error
        self.told(f"workers died with part {job.id}; it is given out again ({losses} of {LOSSES})")
        future.retry()
        self._jobs[future] = job
        completed.add(future)

    def _cancel(self) -> None:
        futures = list(self._jobs)
        self._jobs.clear()
        if futures and self.client.status == "running":
            try:
                self.client.cancel(futures)
            except Exception as error:  # noqa: BLE001  the error that ended the run is the one to tell
                self.told(f"parts that are being made could not be cancelled: {error!r}")
