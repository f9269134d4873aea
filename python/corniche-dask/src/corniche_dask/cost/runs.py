"""Measured builds, read from the reports of ``corniche-dask build --report``."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from corniche.errors import UsageError

from ..summary import VERSION


@dataclass(frozen=True)
class Size:
    """The size of a build, on which its cost depends."""

    nodes: float
    extract_bytes: float
    dem_bytes: float


@dataclass(frozen=True)
class Part:
    """The resources that one part took, and its share of the work of its step."""

    step: str
    share: float
    cpu_seconds: float
    seconds: float
    read_bytes: float
    written_bytes: float
    stored_bytes: float


@dataclass(frozen=True)
class Run:
    """A build, measured from an empty store to the package."""

    name: str
    size: Size
    parts: tuple[Part, ...]
    package_bytes: float

    def of_step(self, step: str) -> list[Part]:
        """The parts of a step."""
        return [part for part in self.parts if part.step == step]


def read_runs(paths: Sequence[str]) -> list[Run]:
    """Reads reports, smallest build first."""
    return sorted((_read(Path(path)) for path in paths), key=lambda run: run.size.nodes)


def _read(path: Path) -> Run:
    try:
        report = json.loads(path.read_text(encoding="utf-8"))
        if report["version"] != VERSION:
            raise UsageError(f"{path}: cannot read a report of version {report['version']}, only of version {VERSION}")
        return _run(path.stem, report)
    except UsageError:
        raise
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise UsageError(f"{path} is not a report of corniche-dask build --report: {error!r}") from error


def _run(name: str, report: dict[str, Any]) -> Run:
    if report["estimate"] is None:
        raise UsageError(f"{name}: the report lacks the number of nodes; create it with options of corniche plan, without --plan")
    inputs = report["input_bytes"]
    size = Size(
        nodes=float(report["estimate"]["nodes"]),
        extract_bytes=float(inputs.get("osm", 0)),
        dem_bytes=float(sum(value for kind, value in inputs.items() if kind not in ("osm", "polygon"))),
    )
    parts = report["parts"]
    # If the build is one subtree, nothing is above it, and top may write nothing.
    reused = [part["id"] for part in parts if not part["was_made"] and part["step"] != "top"]
    if reused:
        raise UsageError(f"{name}: part {reused[0]} was not built by this run; measure with a store that is empty at the beginning")
    work: dict[str, float] = {}
    for part in parts:
        work[part["step"]] = work.get(part["step"], 0.0) + part["work"]
    merged = [part for part in parts if part["step"] == "merge"]
    if len(merged) != 1:
        raise UsageError(f"{name}: the build was not finished")
    return Run(name, size, tuple(_part(name, part, work[part["step"]]) for part in parts), float(merged[0]["file_bytes"] or 0))


def _part(name: str, part: dict[str, Any], work: float) -> Part:
    if part["cpu_seconds"] is None:
        raise UsageError(f"{name}: part {part['id']} has no processor time; measure on Linux")
    if part["was_made"] and part["file_bytes"] is None:
        raise UsageError(f"{name}: the size of part {part['id']} is unknown; measure with a store and a package in folders")
    return Part(
        step=part["step"],
        share=part["work"] / work if work > 0 else 1.0,
        cpu_seconds=part["cpu_seconds"],
        seconds=part["seconds"],
        read_bytes=float(part["read_bytes"] or 0),
        written_bytes=float(part["written_bytes"] or 0),
        stored_bytes=float(part["file_bytes"] or 0) if part["step"] != "merge" else 0.0,
    )
