"""The program ``corniche``: where it is, which version it is, and what it plans."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import dask

from .errors import CornicheError, PartRefused, ProgramError, UsageError

#: Names the program where ``--corniche`` does not.
VARIABLE = "CORNICHE"


def find_program(asked: str | None) -> str:
    """The path of the program on this machine: the one asked for, else ``$CORNICHE``, else the first on ``PATH``."""
    wanted = asked or os.environ.get(VARIABLE) or "corniche"
    found = shutil.which(wanted)
    if found is None:
        raise ProgramError(f"there is no program {wanted}; name it with --corniche, or in ${VARIABLE}, or put it on PATH")
    return os.path.abspath(found)


def version_of(program: str) -> str:
    """What the program calls itself, as plans name it: ``corniche 1.2.3``."""
    try:
        told = subprocess.run([program, "--version"], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise ProgramError(f"{program} does not tell its version: {error}") from error
    if told.returncode != 0:
        raise ProgramError(f"{program} does not tell its version: exit code {told.returncode}: {told.stderr.strip()}")
    # Further lines name libraries.
    return told.stdout.partition("\n")[0].strip()


def environment_of_child() -> dict[str, str]:
    """This process's environment, without what a nanny sets for numerical libraries in Python, such as ``MALLOC_TRIM_THRESHOLD_``."""
    environment = dict(os.environ)
    set_by_nanny: Mapping[str, object] = dask.config.get("distributed.nanny.pre-spawn-environ", default={})
    for name, value in set_by_nanny.items():
        if environment.get(name) == str(value):
            del environment[name]
    return environment


def make_plan(program: str, options: Sequence[str], plan: Path) -> dict[str, object]:
    """Writes the plan of a build with these options of ``corniche plan``; returns its estimates."""
    command = [program, "plan", *options, "-o", str(plan), "-O", "--json"]
    ran = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    if ran.returncode != 0:
        raise PartRefused(f"corniche plan failed:\n{ran.stderr.strip()}", ran.returncode)
    try:
        estimate = json.loads(ran.stdout)["estimate"]
    except (ValueError, KeyError, TypeError) as error:
        raise CornicheError(f"corniche plan printed no estimates: {error!r}") from error
    if not isinstance(estimate, dict):
        raise CornicheError("corniche plan printed no estimates")
    return estimate


def generator_of(plan: str) -> str:
    """Program and version that made a plan, from the plan's text."""
    try:
        generator = json.loads(plan)["generator"]
    except (ValueError, KeyError, TypeError) as error:
        raise UsageError(f"this is no plan of corniche: {error!r}; corniche plan … -o PLAN.json writes one") from error
    return str(generator)
