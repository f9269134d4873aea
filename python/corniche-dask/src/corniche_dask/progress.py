"""The progress of a build: one changing line on a terminal, else a line every ten seconds and at the end of each step."""

from __future__ import annotations

import sys
import threading
import time
from typing import TextIO

from .flow import Flow
from .jobs import Job

#: Seconds between two lines: on a terminal, and elsewhere.
_ON_TERMINAL = 0.5
_ELSEWHERE = 10.0


class Progress:
    """Reports the progress of a build from a separate thread, so that it also appears during long parts."""

    def __init__(self, quiet: bool = False, out: TextIO | None = None) -> None:
        self._out = out or sys.stderr
        self._quiet = quiet
        self._on_terminal = self._out.isatty()
        self._flow: Flow | None = None
        self._begun = time.monotonic()
        self._work_at_begin = 0.0
        self._made = 0
        self._lock = threading.Lock()
        self._over = threading.Event()
        self._thread: threading.Thread | None = None

    def begin(self, flow: Flow) -> None:
        """Starts reporting, when the parts are known."""
        self._flow = flow
        self._begun = time.monotonic()
        self._work_at_begin = flow.work_left
        if not self._quiet:
            self._thread = threading.Thread(target=self._tell_often, name="corniche-progress", daemon=True)
            self._thread.start()

    def made(self, job: Job) -> None:
        """Counts a finished part."""
        self._made += 1
        if self._flow is None or self._on_terminal or self._quiet:
            return
        for step, made, total in self._flow.steps():
            if step == job.step and made == total:
                self._write(f"{step}: all {total} parts after {duration(time.monotonic() - self._begun)}\n")

    def say(self, text: str) -> None:
        """Prints a line, also with ``--quiet``."""
        self._write(("\r\x1b[K" if self._on_terminal and not self._quiet else "") + f"corniche-dask: {text}\n")

    def end(self) -> None:
        """Stops reporting."""
        self._over.set()
        if self._thread is not None:
            self._thread.join()
            self._thread = None
            if self._on_terminal:
                self._write("\r\x1b[K")

    def _tell_often(self) -> None:
        while not self._over.wait(_ON_TERMINAL if self._on_terminal else _ELSEWHERE):
            if self._flow is not None:
                line = self.line(self._flow, time.monotonic() - self._begun)
                self._write(f"\r{line}\x1b[K" if self._on_terminal else f"{line}\n")

    def line(self, flow: Flow, seconds: float) -> str:
        """The progress of the first unfinished steps, as one line."""
        steps = [f"{step} {made} of {total}" for step, made, total in flow.steps() if made < total][:4]
        rate = f"{self._made / seconds * 60:.3g} parts/min" if seconds > 0 else ""
        done = self._work_at_begin - flow.work_left
        left = ""
        if done > 0.02 * self._work_at_begin and flow.work_left > 0:
            left = f"about {duration(seconds * flow.work_left / done)} left"
        share = f"{100 * done / self._work_at_begin:.0f} % of the work" if self._work_at_begin > 0 else ""
        return ", ".join(piece for piece in [*steps, f"{flow.at_work} at work", share, rate, left] if piece)

    def _write(self, text: str) -> None:
        with self._lock:
            self._out.write(text)
            self._out.flush()


def duration(seconds: float) -> str:
    """A duration as text for people."""
    if seconds < 120:
        return f"{seconds:.0f} s"
    if seconds < 7200:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h"
