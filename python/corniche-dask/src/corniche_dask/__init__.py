"""Builds of Corniche, spread over the workers of a Dask cluster.

:func:`build` makes the package of a plan. The command ``corniche-dask build`` plans first, and starts a cluster on this machine if asked to.
"""

from .build import build
from .errors import (
    CornicheError,
    PackageExists,
    PartFailed,
    PartRefused,
    PartsLost,
    ProgramError,
    SchedulerLost,
    UsageError,
)
from .summary import Summary
from .tasks import PartResult

__all__ = [
    "CornicheError",
    "PackageExists",
    "PartFailed",
    "PartRefused",
    "PartResult",
    "PartsLost",
    "ProgramError",
    "SchedulerLost",
    "Summary",
    "UsageError",
    "build",
]
