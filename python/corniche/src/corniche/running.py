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
from .program import find_program
from .records import Stage, error_of, record_of, stage_of, warning_of

#: Who is told how far a command is: a function, or ``True`` for bars.
Progress = Callable[[Stage], object] | bool | None

#: Commands that tell how far they are. A test compares them with the program.
TELL_PROGRESS = frozenset({"build", "part", "merge", "verify", "match", "export"})

#: Options by which this package hears the program, and those that contradict ``--json-progress``.
_VOICE = frozenset({"die_with_parent", "json_progress", "log_format"})
_OTHER_VOICE = frozenset({"quiet", "verbose"})

_ERRORS = {errors.UNUSABLE: errors.UsageError, errors.INTERRUPTED: errors.Interrupted}


@dataclass(frozen=True)
class Ran:
    """What came of a command."""

    exit_code: int
    #: What it was asked to print.
    stdout: str
    #: Why it failed, in words; ``None`` after success, and where a command says so in what it printed.
    error: CornicheError | None

    def printed(self) -> str:
        """What it printed.

        :raises CornicheError: if it failed
        """
        if self.error is not None:
            raise self.error
        return self.stdout


def run(
    *words: str | os.PathLike[str],
    progress: Progress = None,
    corniche: str | os.PathLike[str] | None = None,
    **options: Any,
) -> str:
    """Runs any command of the program and returns what it prints.

    ``run("render", "my.pmtiles", output="my.png", size="800x600")`` is ``corniche render my.pmtiles --output=my.png --size=800x600``.

    :param words: the command, and its arguments as one would write them in a shell; a ``Path`` is never taken for an option
    :param progress: is called with a :class:`Stage` about twice a second; ``True``: bars of tqdm
    :param corniche: the program; ``None``: ``$CORNICHE``, the one of this package, or the one on ``PATH``
    :param options: options of the command: ``max_error=2.5``, ``overwrite=True``, ``dem=["a.tif", "b.tif"]``, ``bounds=(9.5, 46.8, 9.6, 46.9)``
    :raises CornicheError: with the program's own words
    """
    return ran(words, options, progress, corniche).printed()


def ran(
    words: tuple[str | os.PathLike[str], ...],
    options: Mapping[str, object],
    progress: Progress = None,
    corniche: str | os.PathLike[str] | None = None,
) -> Ran:
    """The same, without an exception where the program fails."""
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


def start(command: list[str], options: Mapping[str, object], corniche: str | os.PathLike[str] | None) -> Child:
    """Starts a command so that it tells records, and ends when this process does."""
    tells_progress = bool(command) and command[0] in TELL_PROGRESS
    refuse(options, _VOICE | _OTHER_VOICE if tells_progress else _VOICE)
    voice = ["--json-progress" if tells_progress else "--log-format=json", "--die-with-parent"]
    # It takes no options, and is over at once.
    if command[:1] == ["help"]:
        voice = []
    return Child([find_program(corniche), *command, *voice, *words_of(options)], os.environ)


def refuse(options: Mapping[str, object], reserved: Iterable[str]) -> None:
    """Refuses options that this package gives itself.

    :raises UsageError: and names the option
    """
    for name in sorted(reserved):
        is_off = options.get(name) is None or (options[name] is False and name != "json")
        if not is_off:
            raise UsageError(f"{name}={options[name]!r} is not for Python: these functions set it themselves; leave it out")


class Listener:
    """Hears what a command tells while it runs."""

    def __init__(self, progress: Callable[[Stage], object] | None = None) -> None:
        self._progress = progress
        self._warnings: list[str] = []
        self._error: str | None = None

    def hear(self, line: str) -> None:
        """A line of standard error."""
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
        """Warns of what the program warned of, at the line that called this package."""
        level, frame = 1, sys._getframe()
        while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
            level, frame = level + 1, frame.f_back
        for text in self._warnings:
            warnings.warn(text, CornicheWarning, stacklevel=level)

    def error_of(self, command: list[str], ended: Ended) -> CornicheError | None:
        """Why it failed."""
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
            ways = "resume=True or overwrite=True" if "give --resume" in text else "overwrite=True"
            return errors.UnfinishedBuild(f"{text} (here: {ways})")
        return _ERRORS.get(code, CornicheError)(text)
