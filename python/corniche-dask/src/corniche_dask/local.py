"""A cluster of workers on this machine."""

from __future__ import annotations

import importlib.util
import logging

import dask
from dask.system import CPU_COUNT
from distributed import LocalCluster
from distributed.system import MEMORY_LIMIT

from .limits import SLOT

#: The share of this machine's memory that all its workers use together.
_MEMORY = 0.75
# : Dask's processes run housekeeping up to a hundred times a second, also while they only wait, and
# take this time from the parts: with two : workers 10 % of a core with Dask's defaults, 1.3 % with
# these settings.
_SELDOM = {
    "distributed.worker.profile.enabled": False,
    "distributed.worker.memory.monitor-interval": "1s",
    "distributed.admin.tick.interval": "500ms",
    "distributed.admin.tick.cycle": "5s",
    "distributed.admin.system-monitor.interval": "5s",
    "distributed.scheduler.active-memory-manager.start": False,
    # No part waits at a worker that another could take.
    "distributed.scheduler.work-stealing": False,
}


def local_cluster(workers: int, threads: int | None, memory_bytes: int | None) -> LocalCluster:
    """Starts workers that each run one part at a time.

    :param threads: threads of each worker; ``None``: the processors, divided by the workers
    :param memory_bytes: memory of each worker; ``None``: its share of three quarters of the machine's memory
    """
    # Set for the whole process: workers inherit its configuration when they start, including those
    # that replace a lost one.
    dask.config.set(_SELDOM)
    return LocalCluster(
        n_workers=workers,
        threads_per_worker=threads or max(1, CPU_COUNT // workers),
        # Dask's default gives each worker all memory if it has as many threads as there are
        # processors.
        memory_limit=memory_bytes or int(MEMORY_LIMIT * _MEMORY) // workers,
        resources={SLOT: 1},
        processes=True,
        host="127.0.0.1",
        dashboard_address="127.0.0.1:8787" if importlib.util.find_spec("bokeh") else "127.0.0.1:0",
        # The command itself reports failures.
        silence_logs=logging.CRITICAL,
    )
