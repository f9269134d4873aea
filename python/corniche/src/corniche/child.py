"""A process of ``corniche`` that dies with the process that started it.

Its standard input is a pipe of which this process holds the other end. The kernel closes that end when this process ends, however it ends,
and then ``--die-with-parent`` ends the child. The second net is a process group of the child's own, which :meth:`Child.kill` kills.
A signal at the parent's death is no help: it comes when the *thread* ends that started the child, and a pool ends its threads.
"""

from __future__ import annotations

import os
import select
import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .records import costs_of, error_of, record_of, warning_of

#: How often it is looked at memory, and whether the part is still wanted, in seconds.
LOOK_EVERY = 0.5
#: What a child may take to end after its pipe was closed, in seconds. By itself it ends within ten and a half.
ENDS_WITHIN = 15.0
#: Lines of the log that an error shows.
LAST_LINES = 20
#: Bytes at the end of the log that are looked at.
LOG_BYTES = 64 * 1024


@dataclass(frozen=True)
class Usage:
    """What a child used, as far as the system tells."""

    cpu_seconds: float | None = None
    #: Bytes that it asked the system to read and to write, from disk or from the cache, without network connections.
    read_bytes: int | None = None
    written_bytes: int | None = None
    #: The most resident memory.
    peak_bytes: int | None = None


@dataclass(frozen=True)
class Ended:
    """How a child ended."""

    #: Its exit code; below 0, the signal that ended it.
    exit_code: int
    stdout: str
    #: The last lines of its standard error, without progress.
    log: list[str]
    seconds: float
    usage: Usage
    #: It was told to end, because nobody wanted its result any more.
    was_stopped: bool


class Child:
    """A running process. Several threads may use it."""

    def __init__(self, command: Sequence[str], environment: Mapping[str, str]) -> None:
        self._begun = time.monotonic()
        self._pidfd: int | None = None
        self._stopped_at: float | None = None
        self._peak_bytes: int | None = None
        self._lock = threading.Lock()
        #: How much of its standard error was heard.
        self._heard_bytes = 0
        # Without a name: gone when the last process that has them open is.
        self._stdout = tempfile.TemporaryFile()
        self._stderr = tempfile.TemporaryFile()
        try:
            self._process = subprocess.Popen(
                list(command),
                stdin=subprocess.PIPE,
                stdout=self._stdout,
                stderr=self._stderr,
                env=dict(environment),
                start_new_session=True,
            )
        except BaseException:
            self._close()
            raise
        self._pidfd = _pidfd(self._process.pid)

    @property
    def pid(self) -> int:
        """Its process id, which is also that of its group."""
        return self._process.pid

    def stop(self) -> None:
        """Closes its pipe, so that it ends and keeps what was done."""
        with self._lock:
            if self._stopped_at is None:
                self._stopped_at = time.monotonic()
                if self._process.stdin is not None:
                    self._process.stdin.close()

    def kill(self) -> None:
        """Ends its whole group at once."""
        with self._lock:
            # A process that was waited for may have given its number to another one.
            if self._process.returncode is None:
                try:
                    os.killpg(self._process.pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass

    def wait(self, is_wanted: Callable[[], bool] = lambda: True, heard: Callable[[str], None] | None = None) -> Ended:
        """Waits for its end. When ``is_wanted`` says no, it is stopped, and killed if that does not help.

        ``heard`` is given each line of its standard error, soon after it was written.
        """
        try:
            while not self._is_over(LOOK_EVERY):
                self._look_at_memory()
                self._hear(heard)
                if self._stopped_at is None:
                    if not is_wanted():
                        self.stop()
                elif time.monotonic() - self._stopped_at > ENDS_WITHIN:
                    self.kill()
            self._hear(heard, is_over=True)
            return self._ended()
        except BaseException:
            # Ctrl-C, for example. Asked to end, it leaves no part of a target, and a build its work, to go on from.
            self.stop()
            if not self._is_over(ENDS_WITHIN):
                self.kill()
            self._process.wait()
            raise
        finally:
            self._close()

    def first_line(self) -> str | None:
        """Waits for the first line that it prints on standard output; ``None``: it ended before."""
        is_over = False
        while True:
            # Not by the file's own position, which the child has, too.
            line, end, _ = os.pread(self._stdout.fileno(), LOG_BYTES, 0).partition(b"\n")
            if end:
                return line.decode(errors="replace")
            if is_over:
                return None
            is_over = self._is_over(0.02)

    def _hear(self, heard: Callable[[str], None] | None, is_over: bool = False) -> None:
        """Passes on the lines that are new; what comes behind the last line only when it is over."""
        while heard is not None and (new := os.pread(self._stderr.fileno(), LOG_BYTES, self._heard_bytes)):
            end = new.rfind(b"\n") + 1
            # A line longer than all that is read at once is passed on in pieces.
            if end == 0 and (is_over or len(new) == LOG_BYTES):
                end = len(new)
            if end == 0:
                return
            self._heard_bytes += end
            for line in new[:end].decode(errors="replace").splitlines():
                heard(line)

    def _is_over(self, seconds: float) -> bool:
        """Waits for so long, or to its end."""
        if self._pidfd is None:
            try:
                self._process.wait(seconds)
            except subprocess.TimeoutExpired:
                pass
        else:
            # The process becomes readable when it ends. Popen.wait with a time limit would look twenty times a second.
            waiting = select.poll()
            waiting.register(self._pidfd, select.POLLIN)
            waiting.poll(seconds * 1000)
        with self._lock:
            return self._process.poll() is not None

    def _look_at_memory(self) -> None:
        now = peak_memory(self._process.pid)
        if now is not None:
            self._peak_bytes = max(now, self._peak_bytes or 0)

    def _ended(self) -> Ended:
        exit_code = self._process.returncode
        self._stdout.seek(0)
        stdout = self._stdout.read().decode(errors="replace")
        told, log = read_log(_end_of(self._stderr))
        peaks = [peak for peak in (self._peak_bytes, told.get("peak_memory_bytes")) if peak is not None]
        usage = Usage(
            cpu_seconds=told.get("cpu_seconds"),
            read_bytes=told.get("read_bytes"),
            written_bytes=told.get("written_bytes"),
            peak_bytes=max(peaks, default=None),
        )
        seconds = time.monotonic() - self._begun
        return Ended(exit_code, stdout, log, seconds, usage, self._stopped_at is not None)

    def _close(self) -> None:
        process = getattr(self, "_process", None)
        if process is not None and process.stdin is not None:
            process.stdin.close()
        self._stdout.close()
        self._stderr.close()
        pidfd, self._pidfd = self._pidfd, None
        if pidfd is not None:
            os.close(pidfd)


def _pidfd(pid: int) -> int | None:
    """Something that can be waited for; ``None`` where the system has no such thing."""
    try:
        return os.pidfd_open(pid)
    except (AttributeError, OSError):
        return None


def _end_of(file: Any) -> str:
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - LOG_BYTES))
    return bytes(file.read()).decode(errors="replace")


def read_log(text: str) -> tuple[dict[str, Any], list[str]]:
    """What ``--json-progress`` told at the end of all stages, and the last lines that are for people."""
    told: dict[str, Any] = {}
    log: list[str] = []
    for line in text.splitlines():
        record = record_of(line)
        if record is None:
            log.append(line)
        elif (warning := warning_of(record)) is not None:
            log.append(f"warning: {warning}")
        elif (error := error_of(record)) is not None:
            log.append(f"corniche: {error}")
        else:
            told = costs_of(record) or told
    return told, log[-LAST_LINES:]


def peak_memory(pid: int) -> int | None:
    """The most resident memory of a process so far, in bytes; ``None`` where the system does not tell, or it is over."""
    try:
        with open(f"/proc/{pid}/status", encoding="ascii", errors="replace") as status:
            for line in status:
                if line.startswith("VmHWM:"):
                    return int(line.split()[1]) * 1024
    except (OSError, ValueError, IndexError):
        pass
    return None
