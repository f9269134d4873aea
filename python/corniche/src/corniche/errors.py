"""The errors with which a run can end. Each has the exit code of ``corniche``."""

from __future__ import annotations

from typing import Any

#: Processing failed; for ``verify``: a check is broken.
FAILED = 1
#: Wrong usage or unusable input: another attempt fails in the same way.
UNUSABLE = 2
#: The target exists.
EXISTS = 3
#: Interrupted.
INTERRUPTED = 4


class CornicheError(Exception):
    """The base of all errors of this package. The message is meant for the user."""

    exit_code = FAILED


class UsageError(CornicheError):
    """An option is invalid, or an input cannot be used."""

    exit_code = UNUSABLE


class ProgramError(CornicheError):
    """The program ``corniche`` is missing, or has the wrong version."""

    exit_code = UNUSABLE


class TargetExists(CornicheError):
    """The output exists already, and ``overwrite`` was not given."""

    exit_code = EXISTS


class UnfinishedBuild(CornicheError):
    """An earlier build was stopped and left its progress next to the target: ``resume=True`` resumes it, ``overwrite=True`` starts again."""


class Interrupted(CornicheError):
    """A signal ended the program."""

    exit_code = INTERRUPTED


class PromiseBroken(CornicheError):
    """``verify`` found a broken check; :attr:`document` has the results of all checks."""

    def __init__(self, message: str, document: dict[str, Any]) -> None:
        super().__init__(message)
        self.document = document


class CornicheWarning(UserWarning):
    """A warning of the program."""
