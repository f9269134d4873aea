"""The time, memory and bytes of a build: as a table for people, as JSON for programs (the cost model reads it)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from .tasks import PartResult

#: Version of the JSON.
VERSION = 1


@dataclass
class Summary:
    """The result of a build."""

    #: The path of the package.
    package: str
    #: Wall time in seconds, and the number of parts that could run at once at the beginning.
    seconds: float = 0.0
    slots: int = 0
    parts: list[PartResult] = field(default_factory=list)
    #: The estimate of ``corniche plan``, if it was run.
    estimate: dict[str, Any] | None = None
    #: Bytes of the inputs by kind, from the plan.
    input_bytes: dict[str, int] = field(default_factory=dict)

    def above_memory(self) -> list[str]:
        """A text for each part that used more memory than allowed."""
        return [part.memory_text() for part in self.parts if part.is_above_memory()]

    def to_json(self) -> dict[str, Any]:
        """The whole summary as JSON."""
        return {"version": VERSION, **asdict(self)}

    def to_text(self) -> str:
        """A table with a row for each step."""
        steps: dict[str, list[PartResult]] = {}
        for part in self.parts:
            steps.setdefault(part.step, []).append(part)
        rows = [["step", "parts", "made now", "CPU", "sum of wall", "longest", "peak memory", "read", "written", "stored"]]
        rows += [_row(step, parts) for step, parts in steps.items()]
        rows.append(_row("all", self.parts))
        return table(rows)


def _row(title: str, parts: Sequence[PartResult]) -> list[str]:
    def total(values: Iterable[float | None]) -> float | None:
        known = [value for value in values if value is not None]
        return sum(known) if known else None

    made = [part for part in parts if part.was_made]
    peaks = [part.peak_bytes for part in parts if part.peak_bytes is not None]
    return [
        title,
        str(len(parts)),
        str(len(made)),
        _seconds(total(part.cpu_seconds for part in parts)),
        _seconds(sum(part.seconds for part in parts)),
        _seconds(max((part.seconds for part in parts), default=None)),
        bytes_text(max(peaks, default=None)),
        bytes_text(total(part.read_bytes for part in parts)),
        bytes_text(total(part.written_bytes for part in parts)),
        bytes_text(total(part.file_bytes for part in made)),
    ]


def _seconds(value: float | None) -> str:
    return "" if value is None else f"{value:.1f} s"


def bytes_text(value: float | None) -> str:
    """Bytes as text for people, in powers of 1000; empty if unknown."""
    if value is None:
        return ""
    for unit in ["B", "kB", "MB", "GB", "TB"]:
        if value < 1000 or unit == "TB":
            return f"{value:.0f} {unit}" if unit == "B" else f"{value:.1f} {unit}"
        value /= 1000
    return ""


def table(rows: Sequence[Sequence[str]]) -> str:
    """Aligns rows, of which the first is the heading: the first column to the left, the others to the right."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = []
    for row in rows:
        cells = [row[0].ljust(widths[0])] + [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        lines.append("  ".join(cells).rstrip())
    return "\n".join(lines)
