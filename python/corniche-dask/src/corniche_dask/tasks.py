"""What goes between client and workers: small values only. All state is in the store."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Sequence
from dataclasses import dataclass

from .jobs import Job


@dataclass(frozen=True)
class Setting:
    """What all parts of one build have in common."""

    #: SHA-256 of the plan's text; a worker finds the plan's file by it.
    plan_digest: str
    #: Program and version that made the plan.
    generator: str
    #: The program's path on every worker; ``None``: each machine looks for it.
    program: str | None
    #: The first is written, all are read. Here, and below, paths are absolute, as they are in the plan.
    stores: tuple[str, ...]
    #: Where parts are made before they are uploaded.
    tmp: str | None
    #: Threads and bytes of each process; ``None``: the worker's, divided by its slots.
    threads: int | None
    memory_bytes: int | None
    #: The package.
    output: str
    overwrite: bool
    #: The list of defects.
    defects: str | None


@dataclass(frozen=True)
class PartTask:
    """A part that a worker is to make."""

    key: str
    job: Job
    setting: Setting


@dataclass(frozen=True, kw_only=True)
class PartResult:
    """What became of a part: a digest of it, and what it took."""

    id: str
    step: str
    #: What ``corniche jobs`` estimated, in seconds on one core.
    work: float
    #: 0; or 2 or 3, with an error: it is of no use to try again.
    exit_code: int = 0
    error: str | None = None
    #: Whether it was made now; otherwise it was in the store already, or holds no data.
    was_made: bool = False
    #: The sealed part's file name, or the package's path.
    name: str | None = None
    #: The first 16 bytes of a SHA-256 over the part's content, as the file name has it.
    digest: str | None = None
    #: Bytes of the file, where the worker can look.
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
        """Whether the process used more memory than it was allowed."""
        return self.peak_bytes is not None and self.peak_bytes > self.memory_bytes

    def memory_text(self) -> str:
        """For people: which part used how much of what."""
        mebi = 1 << 20
        return f"part {self.id} used {(self.peak_bytes or 0) / mebi:.0f} MiB of {self.memory_bytes / mebi:.0f} MiB on {self.worker}"


def digest_of(text: str) -> str:
    """SHA-256 of a text, as hexadecimal digits."""
    return hashlib.sha256(text.encode()).hexdigest()


def key_of(setting: Setting, job: Job) -> str:
    """A key that is equal for equal work: step and content. Dask's dashboard shows what is before the last hyphen."""
    content: list[object] = [setting.plan_digest, setting.stores, job.step, job.subtree, job.share, job.args]
    if job.is_merge:
        content += [setting.output, setting.overwrite, setting.defects]
    # 32 digits without any figure would be shown as a word of the name.
    return f"{job.step}-0{digest_of(json.dumps(content))[:32]}"


def is_object_storage(place: str) -> bool:
    """Whether a place is no path, but the address of something elsewhere, such as ``s3://BUCKET/PREFIX``."""
    return "://" in place


def absolute(place: str) -> str:
    """A path that means the same in every folder."""
    return place if is_object_storage(place) else os.path.abspath(place)


def part_of_name(printed: str) -> tuple[str | None, str | None]:
    """File name and digest from the path that ``corniche part`` printed: ``…/parts/NAME.DIGEST.part``."""
    name = printed.strip().rsplit("/", 1)[-1]
    pieces = name.split(".")
    return (name or None, pieces[-2] if len(pieces) >= 3 else None)


def stores_of(store: str | Sequence[str]) -> tuple[str, ...]:
    """One store or several, with absolute paths."""
    return tuple(absolute(place) for place in ([store] if isinstance(store, str) else store))
