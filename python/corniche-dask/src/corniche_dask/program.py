"""Creates plans with the program, and the environment in which it runs."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import dask

from corniche.errors import CornicheError, UsageError
from corniche.running import run


def environment_of_child() -> dict[str, str]:
    """This process's environment, without the variables that a nanny sets for numerical libraries in Python, such as ``MALLOC_TRIM_THRESHOLD_``."""
    environment = dict(os.environ)
    set_by_nanny: Mapping[str, object] = dask.config.get("distributed.nanny.pre-spawn-environ", default={})
    for name, value in set_by_nanny.items():
        if environment.get(name) == str(value):
            del environment[name]
    return environment


def make_plan(program: str, options: Sequence[str], plan: Path) -> dict[str, object]:
    """Writes the plan of a build with these options of ``corniche plan``; returns the estimates."""
    printed = run("plan", *options, corniche=program, output=plan, overwrite=True, json=True)
    try:
        return dict(json.loads(printed)["estimate"])
    except (ValueError, KeyError, TypeError) as error:
        raise CornicheError(f"corniche plan printed no estimates: {error!r}") from error


def generator_of(plan: str) -> str:
    """The program and version that created a plan, from the plan's text."""
    try:
        generator = json.loads(plan)["generator"]
    except (ValueError, KeyError, TypeError) as error:
        raise UsageError(f"this is not a plan of corniche: {error!r}; create one with corniche plan … -o PLAN.json") from error
    return str(generator)
