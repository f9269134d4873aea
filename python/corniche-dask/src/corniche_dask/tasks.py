"""The messages between client and workers: only small values. All state is in the store."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Sequence
from dataclasses import dataclass

from .jobs import Job


@dataclass(frozen=True)
class Setting:
    """The settings that all parts of one build share."""

    #: SHA-256 of the plan's text; a worker finds the plan's file by it.
    plan_digest: str
    #: The program and version that created the plan.
    generator: str
    #: The program's path on every worker; ``None``: each machine searches for it.
    program: str | None
    # : Parts are written to the first store and read from all. Here and below, paths are absolute,
    # as in the plan.
    stores: tuple[str, ...]
    #: The folder in which parts are created before they are uploaded.
    tmp: str | None
    #: Threads and memory of each process; ``None``: the worker's, divided by its slots.
    threads: int | None
    memory_bytes: int | None
    #: The path of the package.
    output: str
    overwrite: bool
    #: The path of the list of defects.
    defects: str | None


@dataclass(frozen=True)
class PartTask:
    """A part for a worker to run."""

    key: str
    job: Job
    setting: Setting


@dataclass(frozen=True, kw_only=True)
class PartResult:
    """The result of a part: its digest, and the resources that it took."""

    id: str
    step: str
    #: The estimate of ``corniche jobs``, in seconds on one core.
    work: float
    #: 0, or 2 or 3 with an error that another attempt would not change.
    exit_code: int = 0
    error: str | None = None
    #: Whether this run built the part; otherwise it was in the store already, or has no data.
    was_made: bool = False
    #: The sealed part's file name, or the package's path.
    name: str | None = None
    #: The first 16 bytes of the SHA-256 of the part's content, as in the file name.
    digest: str | None = None
    #: Size of the file in bytes, if the worker sees the file.
    file_bytes: int | None
    worker: str
    seconds: float
    cpu_seconds: float | None
    read_bytes: int | None
    written_bytes: int | None
    peak_bytes: int | None
    memory_bytes: int
    threads: int

    def is_above_memory(self) -> bool:
        """Whether the process used more memory than allowed."""
        return self.peak_bytes is not None and self.peak_bytes > self.memory_bytes

    def memory_text(self) -> str:
        """A text for people: which part used how much memory, and its limit."""
        mebi = 1 << 20
        return f"part {self.id} used {(self.peak_bytes or 0) / mebi:.0f} MiB of {self.memory_bytes / mebi:.0f} MiB on {self.worker}"


def digest_of(text: str) -> str:
    """SHA-256 of a text, as hexadecimal digits."""
    return hashlib.sha256(text.encode()).hexdigest()


def key_of(setting: Setting, job: Job) -> str:
    """A key that is equal for equal work: step and hash. Dask's dashboard shows the text before the last hyphen."""
    content: list[object] = [setting.plan_digest, setting.stores, job.step, job.subtree, job.share, job.args]
    if job.is_merge:
        content += [setting.output, setting.overwrite, setting.defects]
    # The 0 ensures a digit: the dashboard would show 32 letters as part of the name.
    return f"{job.step}-0{digest_of(json.dumps(content))[:32]}"


def is_object_storage(place: str) -> bool:
    """Whether a place is not a path but an address, such as ``s3://BUCKET/PREFIX``."""
    return "://" in place


def absolute(place: str) -> str:
    """The absolute path; addresses stay unchanged."""
    return place if is_object_storage(place) else os.path.abspath(place)


def part_of_name(printed: str) -> tuple[str | None, str | None]:
    """The file name and the digest in the path that ``corniche part`` printed: ``…/parts/NAME.DIGEST.part``."""
    name = printed.strip().rsplit("/", 1)[-1]
    pieces = name.split(".")
    return (name or None, pieces[-2] if len(pieces) >= 3 else None)


def stores_of(store: str | Sequence[str]) -> tuple[str, ...]:
    """One store or several, with absolute paths."""
    return tuple(absolute(place) for place in ([store] if isinstance(store, str) else store))
