"""Distributes Corniche builds over the workers of a Dask cluster.

:func:`build` builds the package of a plan. The command ``corniche-dask build`` also creates the plan, and with ``--local`` starts a cluster on this
machine. Errors are those of :mod:`corniche.errors` and the errors of clusters listed here.
"""

from .build import build
from .errors import PartFailed, PartRefused, PartsLost, SchedulerLost
from .summary import Summary
from .tasks import PartResult

__all__ = [
    "PartFailed",
    "PartRefused",
    "PartResult",
    "PartsLost",
    "SchedulerLost",
    "Summary",
    "build",
]
