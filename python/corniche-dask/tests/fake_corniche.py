#!/usr/bin/env python3
"""Behaves like ``corniche`` towards its caller, as its plan specifies: for tests of failures that the real program does not produce on demand.

The plan is JSON: ``generator``; ``jobs``, the lines of ``corniche jobs``; ``acts``, by a part's id: ``exit`` (exit code), ``times`` (how often to do this),
``megabytes`` (memory to use), ``sleep`` (seconds, unless standard input ends and ``--die-with-parent`` is given). Each call is noted in a file
named ``calls`` beside the plan's store, with the process id.
"""

import json
import os
import select
import sys
import time
from pathlib import Path


def main() -> int:
    arguments = sys.argv[1:]
    if arguments == ["--version"]:
        print(os.environ.get("FAKE_VERSION", "corniche 9.9.9"))
        return 0
    command, plan_file, *options = arguments
    plan = json.loads(Path(plan_file).read_text())
    if command == "jobs":
        for job in plan["jobs"]:
            print(json.dumps(job))
        return 0
    store = Path(options[options.index("--store") + 1])
    name = options[options.index("--id") + 1] if "--id" in options else command
    with (store.parent / "calls").open("a") as calls:
        calls.write(f"{name} {os.getpid()}\n")
    act = plan.get("acts", {}).get(name, {})
    held = bytearray(act.get("megabytes", 0) << 20)
    for page in range(0, len(held), 4096):
        held[page] = 1
    seen = (store.parent / "calls").read_text().split().count(name)
    is_act = seen <= act.get("times", 1000)
    end = time.monotonic() + (act.get("sleep", 0) if is_act else 0)
    while time.monotonic() < end:
        if "--die-with-parent" not in options:
            time.sleep(0.05)
        elif select.select([sys.stdin], [], [], 0.05)[0] and not sys.stdin.buffer.read1(1024):
            print("corniche: stdin was closed", file=sys.stderr)
            return 1
    if "exit" in act and is_act:
        print(json.dumps({"stage": "tiles", "state": "running"}), file=sys.stderr)
        print(f"corniche: the fake {name} was told to fail", file=sys.stderr)
        return int(act["exit"])
    if command == "merge":
        Path(options[options.index("-o") + 1]).write_text("package\n")
        return 0
    parts = store / "parts"
    parts.mkdir(parents=True, exist_ok=True)
    part = parts / f"{name}.0123456789abcdef.part"
    if not part.exists():
        part.write_text(name)
        print(part)
    all_stages = {"cpu_seconds": time.process_time(), "peak_memory_bytes": peak_memory(), "read_bytes": 1, "written_bytes": len(name)}
    print(json.dumps({"summary": [], "all": all_stages}), file=sys.stderr)
    return 0


def peak_memory() -> int:
    """Prints a record like the real program."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("VmHWM:"))


if __name__ == "__main__":
    sys.exit(main())
