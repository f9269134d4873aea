"""The parts of a build, as ``corniche jobs`` prints them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from corniche.errors import CornicheError

#: The last part: it writes the package.
MERGE = "merge"


@dataclass(frozen=True)
class Job:
    """A part of a build."""

    #: The name of the part, unique within a build.
    id: str
    #: The step: the stage of the build.
    step: str
    #: The root tile of its subtree, ``Z/X/Y``; ``None``: the step has no subtrees.
    subtree: str | None
    #: Its chunk of an extract, ``I/N``; ``None``: the step has no chunks.
    share: str | None
    #: Estimated seconds on one core.
    work: float
    #: The steps all of whose parts must be finished before.
    after: tuple[str, ...]
    #: Arguments for ``corniche part PLAN.json``, or for ``corniche merge``.
    args: tuple[str, ...]

    @property
    def is_merge(self) -> bool:
        """Whether this part writes the package."""
        return self.step == MERGE

    def title(self) -> str:
        """A title for people: the step, and its subtree or chunk."""
        scope = [f"subtree {self.subtree}"] if self.subtree else []
        scope += [f"chunk {self.share}"] if self.share else []
        return ", ".join([f"step {self.step}", *scope])


def parse_jobs(text: str) -> list[Job]:
    """The parts in the lines that ``corniche jobs`` printed.

    Raises ``CornicheError`` if a line is not a part, or if the parts do not form one build that ends with a merge.
    """
    jobs = [_parse(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    ids = {job.id for job in jobs}
    if len(ids) != len(jobs):
        raise CornicheError("corniche jobs: two parts have the same id")
    if [job.step for job in jobs].count(MERGE) != 1:
        raise CornicheError("corniche jobs: there must be exactly one merge")
    order_of_steps(jobs)
    return jobs


def _parse(number: int, line: str) -> Job:
    def optional(value: object) -> str | None:
        return None if value is None else str(value)

    try:
        value = json.loads(line)
        return Job(
            id=str(value["id"]),
            step=str(value["step"]),
            subtree=optional(value["subtree"]),
            share=optional(value["share"]),
            work=float(value["work"]),
            after=tuple(str(step) for step in value["after"]),
            args=tuple(str(argument) for argument in value["args"]),
        )
    except (ValueError, KeyError, TypeError) as error:
        raise CornicheError(f"corniche jobs: line {number} is not a part: {error!r}") from error


def after_of_steps(jobs: Iterable[Job]) -> dict[str, set[str]]:
    """For each step, the steps that must be finished before."""
    after: dict[str, set[str]] = {}
    for job in jobs:
        after.setdefault(job.step, set()).update(job.after)
    return after


def order_of_steps(jobs: Sequence[Job]) -> list[str]:
    """The steps in an order in which they can run.

    Raises ``CornicheError`` if there is no such order, or if a step comes after one without parts.
    """
    after = after_of_steps(jobs)
    order: list[str] = []
    while len(order) < len(after):
        ready = [step for step in after if step not in order and after[step] <= set(order)]
        if not ready:
            stuck = ", ".join(sorted(set(after) - set(order)))
            raise CornicheError(f"corniche jobs: these steps wait for each other, or for steps without parts: {stuck}")
        order.extend(ready)
    return order
