"""Terrain tiles with roads exactly on them: the program ``corniche`` from Python.

:func:`build`, :func:`plan`, :func:`verify`, :func:`info` and :func:`export` run the program and return its documents; :func:`run` runs any other
command, and :func:`serve` shows packages in a browser or a notebook.
"""

from .bars import Bars
from .bundled import sample
from .commands import build, export, info, plan, verify
from .errors import CornicheError, CornicheWarning, Interrupted, ProgramError, PromiseBroken, TargetExists, UnfinishedBuild, UsageError
from .program import find_program, version_of
from .records import Stage
from .running import run
from .serving import Serving, serve

__all__ = [
    "Bars",
    "CornicheError",
    "CornicheWarning",
    "Interrupted",
    "ProgramError",
    "PromiseBroken",
    "Serving",
    "Stage",
    "TargetExists",
    "UnfinishedBuild",
    "UsageError",
    "build",
    "export",
    "find_program",
    "info",
    "plan",
    "run",
    "sample",
    "serve",
    "verify",
    "version_of",
]
