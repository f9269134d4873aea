"""A process of ``corniche`` that ends with the process that started it.

Its standard input is a pipe whose other end this process holds. When this process ends in any way, the kernel closes that end, and
``--die-with-parent`` ends the child. As a second safeguard the child has its own process group, which :meth:`Child.kill` kills.
A signal at the parent's death does not work here: the kernel sends it when the *thread* that started the child ends, and a pool ends its threads.
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

#: Seconds between two checks of the child's memory and of whether its result is still wanted.
LOOK_EVERY = 0.5
# : Seconds that a child may take to end after its pipe was closed. Normally it ends within 10.5
# seconds.
ENDS_WITHIN = 15.0
#: Lines at the end of the log that an error shows.
LAST_LINES = 20
#: Bytes at the end of the log that are searched for these lines.
LOG_BYTES = 64 * 1024


@dataclass(frozen=True)
class Usage:
    """The resources that a child used, as far as the system reports them."""

    cpu_seconds: float | None = None
    # : Bytes that the child read and wrote by system calls, from disk or cache, without network
    # connections.
    read_bytes: int | None = None
    written_bytes: int | None = None
    #: The peak resident memory.
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
    #: Whether the child was stopped, because nobody wanted its result any more.
    was_stopped: bool


class Child:
    """A running process. Several threads may use the same object."""

    def __init__(self, command: Sequence[str], environment: Mapping[str, str]) -> None:
        self._begun = time.monotonic()
        self._pidfd: int | None = None
        self._stopped_at: float | None = None
        self._peak_bytes: int | None = None
        self._lock = threading.Lock()
        #: Bytes of the child's standard error that were read so far.
        self._heard_bytes = 0
        # Files without a name: they are deleted when the last process that has them open ends.
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
        """The process id, which is also the id of the process group."""
        return self._process.pid

    def stop(self) -> None:
        """Closes the child's pipe, so that the child ends and keeps its progress."""
        with self._lock:
            if self._stopped_at is None:
                self._stopped_at = time.monotonic()
                if self._process.stdin is not None:
                    self._process.stdin.close()

    def kill(self) -> None:
        """Kills the child's whole process group."""
        with self._lock:
            # After a process was waited for, the system may reuse its id.
            if self._process.returncode is None:
                try:
                    os.killpg(self._process.pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass

    def wait(self, is_wanted: Callable[[], bool] = lambda: True, heard: Callable[[str], None] | None = None) -> Ended:
        """Waits for the child's end. When ``is_wanted`` returns false, the child is stopped, and killed if it does not end.

        ``heard`` is called with each line of its standard error, soon after it was written.
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
            # For example Ctrl-C. A child that is stopped leaves no incomplete target; a build keeps
            # its progress for --resume.
            self.stop()
            if not self._is_over(ENDS_WITHIN):
                self.kill()
            self._process.wait()
            raise
        finally:
            self._close()

    def first_line(self) -> str | None:
        """Waits for the first line that the child prints on standard output; ``None`` if it ends before."""
        is_over = False
        while True:
            # pread does not move the file's position, which the child shares.
            line, end, _ = os.pread(self._stdout.fileno(), LOG_BYTES, 0).partition(b"\n")
            if end:
                return line.decode(errors="replace")
            if is_over:
                return None
            is_over = self._is_over(0.02)

    def _hear(self, heard: Callable[[str], None] | None, is_over: bool = False) -> None:
        """Passes on new lines. An incomplete last line is passed on only when the process has ended."""
        while heard is not None and (new := os.pread(self._stderr.fileno(), LOG_BYTES, self._heard_bytes)):
            end = new.rfind(b"\n") + 1
            # A line longer than the buffer is passed on in pieces.
            if end == 0 and (is_over or len(new) == LOG_BYTES):
                end = len(new)
            if end == 0:
                return
            self._heard_bytes += end
            for line in new[:end].decode(errors="replace").splitlines():
                heard(line)

    def _is_over(self, seconds: float) -> bool:
        """Waits for some seconds or for the child's end; returns whether it has ended."""
        if self._pidfd is None:
            try:
                self._process.wait(seconds)
            except subprocess.TimeoutExpired:
                pass
        else:
            # The pidfd becomes readable when the process ends. Popen.wait with a time limit would
            # poll twenty times a second.
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
    """A pidfd, which can be polled; ``None`` where the system has no pidfds."""
    try:
        return os.pidfd_open(pid)
    except (AttributeError, OSError):
        return None


def _end_of(file: Any) -> str:
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - LOG_BYTES))
    return bytes(file.read()).decode(errors="replace")


def read_log(text: str) -> tuple[dict[str, Any], list[str]]:
    """The totals that ``--json-progress`` prints after all stages, and the last lines of the log for people."""
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
    """The peak resident memory of a process so far, in bytes; ``None`` if the system does not report it, or the process has ended."""
    try:
        with open(f"/proc/{pid}/status", encoding="ascii", errors="replace") as status:
            for line in status:
                if line.startswith("VmHWM:"):
                    return int(line.split()[1]) * 1024
    except (OSError, ValueError, IndexError):
        pass
    return None
