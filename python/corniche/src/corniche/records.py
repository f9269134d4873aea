"""The lines of the program on standard error: one record per line with ``--json-progress`` or ``--log-format json``, else text."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields
from typing import Any


@dataclass(frozen=True)
class Stage:
    """The progress of a stage of the work. Unknown values are ``None``."""

    #: The stage's id, which does not change between versions, and its title for people.
    stage: str
    title: str
    #: ``begin``, ``running`` or ``end``.
    state: str
    #: The unit of the counts: ``bytes``, ``tiles`` and so on.
    unit: str
    #: The amount done so far; the part of it that an earlier run did; the amount in total.
    done: int
    already: int
    total: int | None
    per_second: float | None
    #: Seconds since the stage began, and estimated seconds until it ends.
    seconds: float
    seconds_left: float | None


_FIELDS = [field.name for field in fields(Stage)]


def record_of(line: str) -> dict[str, Any] | None:
    """The record in a line; ``None`` if the line is text."""
    try:
        value = json.loads(line)
    except ValueError:
        return None
    return value if isinstance(value, dict) else None


def stage_of(record: dict[str, Any]) -> Stage | None:
    """The progress of a stage, if the record has one. Later versions may add fields."""
    if "stage" not in record or "state" not in record:
        return None
    told: dict[str, Any] = {name: record.get(name) for name in _FIELDS}
    return Stage(**told)


def warning_of(record: dict[str, Any]) -> str | None:
    """The message, if the record is a warning."""
    if record.get("level") == "WARN":
        return str(record.get("message"))
    return str(record["warning"]) if "warning" in record else None


def error_of(record: dict[str, Any]) -> str | None:
    """The reason why the run failed, if the record has one."""
    if record.get("level") == "ERROR":
        return str(record.get("message"))
    end = record.get("end")
    return end.get("error") if isinstance(end, dict) else None


def costs_of(record: dict[str, Any]) -> dict[str, Any] | None:
    """The resources that the whole run took, if the record has them."""
    return record["all"] if isinstance(record.get("all"), dict) else None
