"""Why a run ends early. Each error has the exit code that ``corniche`` ends with."""

from __future__ import annotations

from typing import Any

#: Processing failed; of ``verify``, a promise is broken.
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
    """What was asked for cannot be done: an option is wrong, or an input cannot be used."""

    exit_code = UNUSABLE


class ProgramError(CornicheError):
    """The program ``corniche`` is not there, or is of another version than wanted."""

    exit_code = UNUSABLE


class TargetExists(CornicheError):
    """The file to write is there already, and it was not asked to replace it."""

    exit_code = EXISTS


class UnfinishedBuild(CornicheError):
    """An earlier build was stopped and left its work beside the target: ``resume=True`` goes on from there, ``overwrite=True`` starts again."""


class Interrupted(CornicheError):
    """A signal ended the program."""

    exit_code = INTERRUPTED


class PromiseBroken(CornicheError):
    """``verify`` found a promise that a package breaks; :attr:`document` is all that it found."""

    def __init__(self, message: str, document: dict[str, Any]) -> None:
        super().__init__(message)
        self.document = document


class CornicheWarning(UserWarning):
    """What the program warns of."""
