"""The number of parts that a worker runs at once, and the resources that each may use."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from corniche.errors import UsageError

#: The Dask resource that declares how many parts a worker runs at once.
SLOT = "slot"
#: The part of a worker's memory that its Python process takes, in bytes.
WORKER_BYTES = 192 << 20
#: The least memory that corniche works with, in bytes.
LEAST_BYTES = 256 << 20
# : The memory of a process whose worker has no limit, in bytes: the largest default of corniche
# itself.
DEFAULT_BYTES = 4 << 30


@dataclass(frozen=True)
class Limits:
    """The resources that one process of corniche may use."""

    threads: int
    memory_bytes: int


def limits_of(
    worker: str,
    threads: int,
    memory_bytes: int | None,
    resources: Mapping[str, float],
    asked_threads: int | None = None,
    asked_bytes: int | None = None,
) -> Limits:
    """The resources of one slot of a worker with the given threads, memory (``None``: no limit) and Dask resources."""
    slots = max(1, int(resources.get(SLOT, threads)))
    of_memory = DEFAULT_BYTES if memory_bytes is None else (memory_bytes - WORKER_BYTES) // slots
    limits = Limits(asked_threads or max(1, threads // slots), asked_bytes or of_memory)
    if limits.memory_bytes < LEAST_BYTES:
        mebi = 1 << 20
        raise UsageError(
            f"worker {worker} has {(memory_bytes or 0) // mebi} MiB for {slots} parts at once, and itself takes {WORKER_BYTES // mebi} MiB; "
            f"a part needs {LEAST_BYTES // mebi} MiB: give workers more memory, or fewer threads or slots"
        )
    return limits


def slots_of(workers: Mapping[str, Mapping[str, Any]]) -> tuple[int, bool]:
    """The number of parts that all workers run at once, from the scheduler's information, and whether they declare slots."""
    declared = [int((worker.get("resources") or {}).get(SLOT, 0)) for worker in workers.values()]
    if any(declared):
        return sum(declared), True
    return sum(int(worker["nthreads"]) for worker in workers.values()), False


def parse_bytes(text: str) -> int:
    """Parses bytes like ``corniche --memory``: 512M, 4G and 4GiB are powers of 1024, 8GB is one of 1000."""
    written = text.strip().upper()
    digits = written.rstrip("KMGTIB")
    unit = written[len(digits) :]
    powers = {"K": 1, "M": 2, "G": 3, "T": 4}
    try:
        if unit in ("", "B"):
            factor = 1
        elif unit[1:] in ("", "IB"):
            factor = 1024 ** powers[unit[0]]
        else:
            factor = {"B": 1000}[unit[1:]] ** powers[unit[0]]
        parsed = int(float(digits) * factor)
    except (KeyError, ValueError, OverflowError) as error:
        raise UsageError(f"{text!r} is not a size; write it as 512M, 4GiB or 8GB") from error
    if parsed <= 0:
        raise UsageError(f"{text!r} is not a size above 0")
    return parsed
