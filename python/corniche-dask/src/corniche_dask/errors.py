"""Why a build on a cluster ends early. Each error has the exit code that the command ends with, the same as those of ``corniche``."""

from __future__ import annotations

#: Processing failed.
FAILED = 1
#: Wrong usage or unusable input: trying again gives the same.
UNUSABLE = 2
#: The target exists.
EXISTS = 3
#: Interrupted.
INTERRUPTED = 4


class CornicheError(Exception):
    """The base of all errors of this package. Its text is for the user."""

    exit_code = FAILED


class UsageError(CornicheError):
    """What was asked for cannot be done."""

    exit_code = UNUSABLE


class ProgramError(CornicheError):
    """The program ``corniche`` is not there, or is of another version than the plan."""

    exit_code = UNUSABLE


class PackageExists(CornicheError):
    """The package is there already, and it was not asked to replace it."""

    exit_code = EXISTS


class PartRefused(CornicheError):
    """A part ended with exit code 2 or 3. It would do so again, so it is not tried again."""

    def __init__(self, message: str, exit_code: int = UNUSABLE) -> None:
        super().__init__(message, exit_code)
        self.exit_code = exit_code

    def __str__(self) -> str:
        return str(self.args[0])


class PartFailed(CornicheError):
    """A part failed. Dask tries it again, on this or on another worker; what was done of it is kept in the store."""


class PartsLost(CornicheError):
    """Workers died again and again while they made the same part."""


class SchedulerLost(CornicheError):
    """The connection to the scheduler broke. The same command goes on from what is in the store."""
