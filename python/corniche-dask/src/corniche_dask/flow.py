"""Decides which part is submitted next. Independent of Dask."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Sequence

from corniche.errors import CornicheError

from .jobs import Job, after_of_steps, order_of_steps

#: Lists the parts of a step again when the step can begin; ``None``: they stay unchanged.
Refine = Callable[[str], Sequence[Job] | None]


class Flow:
    """The parts of a build: those that wait for other steps, those that are ready, and those that are running.

    A step begins when all parts of the steps before it are finished. Of the ready parts, the one that begins the longest chain of work
    is submitted first, so within a step the largest.
    """

    def __init__(self, jobs: Sequence[Job], refine: Refine | None = None) -> None:
        self._refine = refine
        self._after = after_of_steps(jobs)
        self._chain = _chains(jobs)
        self._waiting: dict[str, list[Job]] = {step: [] for step in order_of_steps(jobs)}
        for job in jobs:
            self._waiting[job.step].append(job)
        self._total = {step: len(parts) for step, parts in self._waiting.items()}
        #: Estimated seconds on one core of all unfinished parts.
        self.work_left = sum(job.work for job in jobs)
        self._made = dict.fromkeys(self._waiting, 0)
        self._over: set[str] = set()
        self._ready: list[tuple[float, str, Job]] = []
        self._at_work: dict[str, Job] = {}
        self._begin_steps()

    @property
    def is_over(self) -> bool:
        """Whether all parts are finished."""
        return not self._waiting and not self._ready and not self._at_work

    @property
    def at_work(self) -> int:
        """The number of running parts."""
        return len(self._at_work)

    def steps(self) -> list[tuple[str, int, int]]:
        """Each step with the number of its finished parts, and of all its parts."""
        return [(step, self._made[step], self._total[step]) for step in self._total]

    def rank(self, job: Job) -> float:
        """Seconds on one core of the longest chain of parts that begins with this one: the larger, the sooner."""
        return job.work + self._chain[job.step]

    def take(self) -> Job | None:
        """Takes the next part to run; ``None`` if no part is ready until others are finished."""
        if not self._ready:
            return None
        _, _, job = heapq.heappop(self._ready)
        self._at_work[job.id] = job
        return job

    def made(self, job: Job) -> None:
        """Records that a part is finished."""
        if self._at_work.pop(job.id, None) is None:
            raise CornicheError(f"part {job.id} is finished, but was never submitted")
        self._made[job.step] += 1
        self.work_left -= job.work
        if self._made[job.step] == self._total[job.step]:
            self._over.add(job.step)
            self._begin_steps()

    def _begin_steps(self) -> None:
        for step in [step for step in self._waiting if self._after[step] <= self._over]:
            jobs = self._waiting.pop(step)
            refined = self._refine(step) if self._refine else None
            if refined is not None:
                if not refined or any(job.step != step for job in refined):
                    raise CornicheError(f"the new list of parts of step {step} is empty or has parts of another step")
                self.work_left += sum(job.work for job in refined) - sum(job.work for job in jobs)
                self._total[step] = len(refined)
                jobs = list(refined)
            for job in jobs:
                heapq.heappush(self._ready, (-self.rank(job), job.id, job))


def _chains(jobs: Sequence[Job]) -> dict[str, float]:
    """For each step, the work of the longest chain of parts after it."""
    after = after_of_steps(jobs)
    longest: dict[str, float] = {}
    for job in jobs:
        longest[job.step] = max(longest.get(job.step, 0.0), job.work)
    chains: dict[str, float] = {}
    for step in reversed(order_of_steps(jobs)):
        later = [other for other in after if step in after[other]]
        chains[step] = max((longest[other] + chains[other] for other in later), default=0.0)
    return chains
