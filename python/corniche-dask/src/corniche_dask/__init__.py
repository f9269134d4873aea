"""Builds of Corniche, spread over the workers of a Dask cluster.

:func:`build` makes the package of a plan. The command ``corniche-dask build`` plans first, and starts a cluster on this machine if asked to.
Errors are those of :mod:`corniche.errors`, and those of clusters that are listed here.
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
