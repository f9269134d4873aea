"""A cluster of processes that tests kill: the scheduler, nannies with their workers, and the command as client."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from conftest import LEAST_WORK, processes_of

#: The number of workers, each of which runs one part at a time.
NANNIES = 2
#: The kinds of processes that can be killed.
KINDS = ("worker", "nanny", "scheduler", "client", "child")
#: Seconds within which processes must begin and end.
PATIENCE = 60.0


class Rig:
    """Ends all processes that it started when its block is left."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._file = folder / "scheduler.json"
        self._log = (folder / "cluster.log").open("ab")
        self._scheduler: subprocess.Popen[bytes] | None = None
        self._nannies: list[subprocess.Popen[bytes]] = []

    def __enter__(self) -> Rig:
        self.repair()
        return self

    def __exit__(self, *_: object) -> None:
        for process in [*self._nannies, self._scheduler]:
            end(process)
        self._log.close()

    def repair(self) -> None:
        """Starts missing processes. Without a scheduler, the workers end, too."""
        if self._scheduler is None or self._scheduler.poll() is not None:
            for nanny in self._nannies:
                end(nanny)
            self._nannies = []
            self._file.unlink(missing_ok=True)
            self._scheduler = self._start("scheduler", "--port", "0", "--no-dashboard")
            wait_for(lambda: self._file.exists() and json.loads(self._file.read_text() or "null"), "the scheduler")
        self._nannies = [nanny for nanny in self._nannies if nanny.poll() is None]
        while len(self._nannies) < NANNIES:
            options = ["--nthreads", "1", "--resources", "slot=1", "--memory-limit", "600MB", "--death-timeout", "10", "--no-dashboard"]
            self._nannies.append(self._start("worker", *options, "--local-directory", str(self._folder)))

    def _start(self, what: str, *options: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "dask", what, "--scheduler-file", str(self._file), *options]
        return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self._log, stderr=self._log, cwd=self._folder)

    def begin(self, corniche: str, plan: Path, store: Path, package: Path) -> subprocess.Popen[bytes]:
        """The command, which is the client."""
        command = [sys.executable, "-m", "corniche_dask", "build", "--scheduler-file", str(self._file), "--plan", str(plan), "--corniche", corniche]
        command += ["--slots", str(NANNIES), "--least-work", str(LEAST_WORK), "--store", str(store), "-o", str(package)]
        return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self._log, stderr=self._log)

    def log(self) -> str:
        """The output of all processes so far."""
        return (self._folder / "cluster.log").read_text(errors="replace")

    def kill(self, kind: str, client: subprocess.Popen[bytes], store: Path, pick: int) -> bool:
        """Kills a process of the given kind with SIGKILL; false if there is none at this moment."""
        if kind == "client":
            pids = [client.pid] if client.poll() is None else []
        elif kind == "scheduler":
            pids = [self._scheduler.pid] if self._scheduler else []
        elif kind == "nanny":
            pids = [nanny.pid for nanny in self._nannies if nanny.poll() is None]
        elif kind == "worker":
            pids = [pid for nanny in self._nannies for pid in children_of(nanny.pid)]
        else:
            pids = list(processes_of(str(store)))
        if not pids:
            return False
        try:
            os.kill(sorted(pids)[pick % len(pids)], signal.SIGKILL)
        except ProcessLookupError:
            return False
        return True


def end(process: subprocess.Popen[bytes] | None) -> None:
    """Ends a process that this one started."""
    if process is not None and process.poll() is None:
        process.terminate()
        try:
            process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
    if process is not None:
        process.wait()


def wait_for(is_so: object, what: str) -> None:
    """Waits until the condition holds."""
    stop = time.monotonic() + PATIENCE
    while not is_so():  # type: ignore[operator]
        assert time.monotonic() < stop, f"no sign of {what}"
        time.sleep(0.05)


def children_of(pid: int) -> list[int]:
    """Processes of Python that a nanny began as workers; its other child only tracks shared memory."""
    found = []
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                parent = int((folder / "stat").read_text().rsplit(")", 1)[1].split()[1])
                line = (folder / "cmdline").read_bytes()
            except (OSError, IndexError):
                continue
            if parent == pid and b"spawn_main" in line:
                found.append(int(folder.name))
    return found
