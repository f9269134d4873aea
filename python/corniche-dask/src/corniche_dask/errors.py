"""Why a build on a cluster ends early, besides the errors of ``corniche`` itself."""

from __future__ import annotations

from corniche.errors import UNUSABLE, CornicheError


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
