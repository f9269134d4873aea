"""Running a command of the program: its warnings, its progress, and how it ended."""

from __future__ import annotations

import os
import signal
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from . import errors
from .bars import Bars
from .child import Child, Ended
from .errors import CornicheError, CornicheWarning, UsageError
from .options import word_of_path, words_of
from .program import Place, find_program
from .records import Stage, error_of, record_of, stage_of, warning_of

#: How progress is reported: a function that is called with it, or ``True`` for bars.
Progress = Callable[[Stage], object] | bool | None

#: Commands that report progress. A test compares them with the program.
TELL_PROGRESS = frozenset({"build", "part", "merge", "verify", "match", "export"})

# : Options that this package sets to read the program's messages, and options that contradict
# ``--json-progress``.
_VOICE = frozenset({"die_with_parent", "json_progress", "log_format"})
_OTHER_VOICE = frozenset({"quiet", "verbose"})

_ERRORS = {errors.UNUSABLE: errors.UsageError, errors.INTERRUPTED: errors.Interrupted}


@dataclass(frozen=True)
class Ran:
    """The result of a command."""

    exit_code: int
    #: The standard output of the command.
    stdout: str
    #: The reason why the command failed; ``None`` after success.
    error: CornicheError | None

    def printed(self) -> str:
        """The standard output.

        :raises CornicheError: if the command failed
        """
        if self.error is not None:
            raise self.error
        return self.stdout


def run(
    *words: Place,
    progress: Progress = None,
    corniche: Place | None = None,
    **options: Any,
) -> str:
    """Runs any command of the program and returns what it prints.

    ``run("render", "my.pmtiles", output="my.png", size="800x600")`` is ``corniche render my.pmtiles --output=my.png --size=800x600``.

    :param words: the command, and its arguments as in a shell; a ``Path`` is never treated as an option
    :param progress: a function that is called with a :class:`Stage` about twice a second; ``True`` shows bars of tqdm
    :param corniche: the path of the program; ``None``: ``$CORNICHE``, the program in this package, or the one on ``PATH``
    :param options: options of the command: ``max_error=2.5``, ``overwrite=True``, ``dem=["a.tif", "b.tif"]``, ``bounds=(9.5, 46.8, 9.6, 46.9)``
    :raises CornicheError: with the message of the program
    """
    return ran(words, options, progress, corniche).printed()


def ran(
    words: tuple[Place, ...],
    options: Mapping[str, object],
    progress: Progress = None,
    corniche: Place | None = None,
) -> Ran:
    """Like :func:`run`, but does not raise if the program fails."""
    command = [word if isinstance(word, str) else word_of_path(word) for word in words]
    teller = Bars() if progress is True else progress or None
    child = start(command, options, corniche)
    listener = Listener(teller)
    try:
        ended = child.wait(heard=listener.hear)
    finally:
        if isinstance(teller, Bars):
            teller.close()
    listener.warn()
    return Ran(ended.exit_code, ended.stdout, listener.error_of(command, ended))


def start(command: list[str], options: Mapping[str, object], corniche: Place | None) -> Child:
    """Starts a command that writes records to standard error, and ends when this process ends."""
    tells_progress = bool(command) and command[0] in TELL_PROGRESS
    refuse(options, _VOICE | _OTHER_VOICE if tells_progress else _VOICE)
    voice = ["--json-progress" if tells_progress else "--log-format=json", "--die-with-parent"]
    # ``help`` takes no options, and ends at once.
    if command[:1] == ["help"]:
        voice = []
    return Child([find_program(corniche), *command, *voice, *words_of(options)], os.environ)


def refuse(options: Mapping[str, object], reserved: Iterable[str]) -> None:
    """Rejects options that this package sets itself.

    :raises UsageError: with the name of the option
    """
    for name in sorted(reserved):
        is_off = options.get(name) is None or (options[name] is False and name != "json")
        if not is_off:
            raise UsageError(f"{name}={options[name]!r} is not available in Python: these functions set it themselves; omit it")


class Listener:
    """Reads the records of a running command."""

    def __init__(self, progress: Callable[[Stage], object] | None = None) -> None:
        self._progress = progress
        self._warnings: list[str] = []
        self._error: str | None = None

    def hear(self, line: str) -> None:
        """Takes a line of standard error."""
        record = record_of(line)
        if record is None:
            return
        if (stage := stage_of(record)) is not None:
            if self._progress is not None:
                self._progress(stage)
        elif (warning := warning_of(record)) is not None:
            self._warnings.append(warning)
        else:
            self._error = error_of(record) or self._error

    def warn(self) -> None:
        """Passes on the program's warnings, attributed to the line that called this package."""
        level, frame = 1, sys._getframe()
        while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
            level, frame = level + 1, frame.f_back
        for text in self._warnings:
            warnings.warn(text, CornicheWarning, stacklevel=level)

    def error_of(self, command: list[str], ended: Ended) -> CornicheError | None:
        """The error of a command that failed; ``None`` if it succeeded."""
        code = ended.exit_code
        if code == 0:
            return None
        name = "corniche " + " ".join(command[:1])
        if code < 0:
            text = f"{name} was ended by {signal.Signals(-code).name}; did the system run out of memory?"
            return CornicheError("\n".join([text, *ended.log]))
        text = self._error or "\n".join([f"{name} ended with exit code {code}", *ended.log])
        if code == errors.EXISTS:
            return errors.TargetExists(f"{text} (here: overwrite=True)")
        # The program has no exit code of its own for this.
        if "-O to start again" in text:
            ways = "resume=True or overwrite=True" if "pass --resume" in text else "overwrite=True"
            return errors.UnfinishedBuild(f"{text} (here: {ways})")
        return _ERRORS.get(code, CornicheError)(text)
