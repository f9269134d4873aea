"""What the program tells on standard error: a record a line with ``--json-progress`` or ``--log-format json``, else text."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields
from typing import Any


@dataclass(frozen=True)
class Stage:
    """How far a stage of the work is. What is not known is ``None``."""

    #: Its name, which does not change, and its name for people.
    stage: str
    title: str
    #: ``begin``, ``running`` or ``end``.
    state: str
    #: What is counted: ``bytes``, ``tiles`` and so on.
    unit: str
    #: Done in all; of that, by an earlier run; to be done in all.
    done: int
    already: int
    total: int | None
    per_second: float | None
    #: Since the stage began, and until it ends.
    seconds: float
    seconds_left: float | None


_FIELDS = [field.name for field in fields(Stage)]


def record_of(line: str) -> dict[str, Any] | None:
    """The record of a line; ``None``: it is text."""
    try:
        value = json.loads(line)
    except ValueError:
        return None
    return value if isinstance(value, dict) else None


def stage_of(record: dict[str, Any]) -> Stage | None:
    """How far a stage is, if the record tells of one. Later versions may tell more of it."""
    if "stage" not in record or "state" not in record:
        return None
    told: dict[str, Any] = {name: record.get(name) for name in _FIELDS}
    return Stage(**told)


def warning_of(record: dict[str, Any]) -> str | None:
    """What is warned of, if the record is a warning."""
    if record.get("level") == "WARN":
        return str(record.get("message"))
    return str(record["warning"]) if "warning" in record else None


def error_of(record: dict[str, Any]) -> str | None:
    """Why the run failed, if the record tells."""
    if record.get("level") == "ERROR":
        return str(record.get("message"))
    end = record.get("end")
    return end.get("error") if isinstance(end, dict) else None


def costs_of(record: dict[str, Any]) -> dict[str, Any] | None:
    """What the whole run took, if the record tells."""
    return record["all"] if isinstance(record.get("all"), dict) else None
