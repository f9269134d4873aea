"""A child ends with its parent, in whatever way the parent ends, and not before."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from pathlib import Path

import pytest

from corniche import child as children
from corniche.child import Child, read_log

#: Ends when its standard input ends, like ``--die-with-parent``.
DIES_WITH_PARENT = "import sys; sys.stdin.read(); sys.exit(1)"
#: Ignores its standard input.
DEAF = "import time; time.sleep(600)"
#: Ignores its standard input, and has a child in its process group.
DEAF_WITH_CHILD = "import subprocess, sys, time; subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)']); time.sleep(600)"


def start(code: str) -> Child:
    return Child([sys.executable, "-c", code], os.environ)


def is_alive(pid: int) -> bool:
    """Whether a process runs; a zombie does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


def wait_until_gone(pid: int, within: float = 10.0) -> None:
    end = time.monotonic() + within
    while is_alive(pid):
        assert time.monotonic() < end, f"{pid} is still there"
        time.sleep(0.02)


def test_what_it_printed_and_how_it_ended() -> None:
    ended = start("import sys; print('path'); print('why', file=sys.stderr); sys.exit(3)").wait(lambda: True)
    assert (ended.exit_code, ended.stdout, ended.log, ended.was_stopped) == (3, "path\n", ["why"], False)
    assert ended.seconds > 0


def test_it_lives_while_the_thread_that_started_it_is_gone() -> None:
    begun: list[Child] = []
    thread = threading.Thread(target=lambda: begun.append(start(DIES_WITH_PARENT)))
    thread.start()
    thread.join()
    time.sleep(1)
    assert is_alive(begun[0].pid)
    begun[0].stop()
    assert begun[0].wait(lambda: True).exit_code == 1


def test_it_ends_when_nobody_wants_it() -> None:
    wanted = [True, True, False]
    ended = start(DIES_WITH_PARENT).wait(lambda: wanted.pop(0))
    assert ended.was_stopped and ended.exit_code == 1


def test_one_that_does_not_listen_is_killed_with_its_group(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(children, "ENDS_WITHIN", 0.5)
    child = start(DEAF_WITH_CHILD)
    group = child.pid
    below = 0
    while not below:
        told = subprocess.run(["ps", "-o", "pid=", "--ppid", str(group)], capture_output=True, text=True, check=False)
        below = int(told.stdout.split()[0]) if told.stdout.split() else 0
    ended = child.wait(lambda: False)
    assert ended.exit_code == -signal.SIGKILL
    wait_until_gone(below)


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_it_ends_when_its_parent_is_killed(number: signal.Signals, tmp_path: Path) -> None:
    """Two children of one parent: neither keeps the pipe of the other open."""
    parent = tmp_path / "parent.py"
    parent.write_text(
        textwrap.dedent(
            f"""
            import os, sys, time
            from corniche.child import Child
            children = [Child([sys.executable, "-c", {DIES_WITH_PARENT!r}], os.environ) for _ in range(2)]
            print(*(child.pid for child in children), flush=True)
            time.sleep(600)
            """
        )
    )
    process = subprocess.Popen([sys.executable, str(parent)], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    pids = [int(pid) for pid in process.stdout.readline().split()]
    time.sleep(0.5)
    assert len(pids) == 2 and all(map(is_alive, pids))
    process.send_signal(number)
    process.wait()
    for pid in pids:
        wait_until_gone(pid)


def test_peak_memory_is_that_of_the_child_alone() -> None:
    """The peak is not that of this process, from which the child was forked, and includes memory that was freed again."""
    here = bytearray(400 << 20)
    for page in range(0, len(here), 4096):
        here[page] = 1
    code = "import time; held = bytearray(100 << 20); held[::4096] = bytes(len(held[::4096])); time.sleep(1.2); del held; time.sleep(0.6)"
    peak = start(code).wait(lambda: True).usage.peak_bytes
    assert peak is not None and 100 << 20 < peak < 200 << 20, peak


def test_the_log_is_what_is_for_people() -> None:
    lines = [
        json.dumps({"stage": "tiles", "state": "running", "done": 3}),
        "corniche: an error",
        json.dumps({"warning": "a warning"}),
        json.dumps({"summary": [], "all": {"cpu_seconds": 1.5, "peak_memory_bytes": 7, "read_bytes": None, "written_bytes": 2}}),
        "5",
        json.dumps({"end": {"result": "done", "exit_code": 0, "error": None, "seconds": 1.0}}),
    ]
    told, log = read_log("\n".join(lines))
    assert log == ["corniche: an error", "warning: a warning", "5"]
    assert told == {"cpu_seconds": 1.5, "peak_memory_bytes": 7, "read_bytes": None, "written_bytes": 2}
    end = json.dumps({"end": {"result": "unusable", "exit_code": 2, "error": "no such file", "seconds": 0.1}})
    assert read_log(end) == ({}, ["corniche: no such file"])
    assert len(read_log("\n".join(str(number) for number in range(100)))[1]) == children.LAST_LINES


def test_a_long_log_fills_no_pipe() -> None:
    ended = start("import sys; [print('x' * 1000, file=sys.stderr) for _ in range(2000)]; print('y' * 200000)").wait(lambda: True)
    assert ended.exit_code == 0 and len(ended.stdout) == 200001 and len(ended.log) == children.LAST_LINES
