"""Errors of a build on a cluster, in addition to those of ``corniche`` itself."""

from __future__ import annotations

from corniche.errors import UNUSABLE, CornicheError


class PartRefused(CornicheError):
    """A part ended with exit code 2 or 3. It is not retried, because it would fail again."""

    def __init__(self, message: str, exit_code: int = UNUSABLE) -> None:
        super().__init__(message, exit_code)
        self.exit_code = exit_code

    def __str__(self) -> str:
        return str(self.args[0])


class PartFailed(CornicheError):
    """A part failed. Dask retries it on this or another worker; its progress is kept in the store."""


class PartsLost(CornicheError):
    """Workers died repeatedly while they ran the same part."""


class SchedulerLost(CornicheError):
    """The connection to the scheduler is lost. Repeat the command to resume from the store."""
