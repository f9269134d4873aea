"""The cost of each step as a sum of terms: so much for a node, for a byte of the extract, for a byte of input, for a part.

The terms of a step are those that its work depends on; the factors come from all measured parts. A part's nodes are not known, but its share of
the estimated work of its step is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from .fit import fit
from .runs import Part, Run, Size

#: What a term counts, for the part of a step that has a share of its work, in a build of a size that consists of so many parts.
NODE, EXTRACT, INPUT, PART, PARTS = "node", "extract byte", "input byte", "part", "part of the build"

#: The steps, in their order, with the terms of their cost. Top and merge read something of every part.
STEPS: dict[str, tuple[str, ...]] = {
    "hashes": (INPUT, PART),
    "ways": (EXTRACT, PART),
    "nodes": (EXTRACT, PART),
    "roads": (EXTRACT, PART),
    "heights": (NODE, PART),
    "top": (PARTS, PART),
    "tiles": (NODE, EXTRACT, PART),
    "merge": (NODE, EXTRACT, PARTS),
}
#: Steps of one part: no number of workers makes them shorter.
SERIAL = ("hashes", "roads", "top", "merge")

#: What is told of a part, by name. Steps that only one process makes are counted by the clock, which includes waiting for the disk.
MEASURES: dict[str, Callable[[Part], float]] = {
    "seconds": lambda part: max(part.cpu_seconds, part.seconds) if part.step in SERIAL else part.cpu_seconds,
    "read": lambda part: part.read_bytes,
    "written": lambda part: part.written_bytes,
    "stored": lambda part: part.stored_bytes,
}


@dataclass(frozen=True)
class Shape:
    """Into how many parts a build is divided."""

    heights: int
    tiles: int
    shares: int

    @property
    def parts(self) -> int:
        """All of them that top and merge read."""
        return self.heights + self.tiles

    def of_step(self, step: str) -> int:
        """The parts of one step."""
        return {"heights": self.heights, "tiles": self.tiles, "ways": self.shares, "nodes": self.shares}.get(step, 1)


def shape_of(run: Run) -> Shape:
    """How a measured build was divided."""
    return Shape(len(run.of_step("heights")), len(run.of_step("tiles")), max(1, len(run.of_step("ways"))))


def _count(term: str, size: Size, share: float, shape: Shape) -> float:
    counts = {
        NODE: size.nodes * share,
        EXTRACT: size.extract_bytes * share,
        INPUT: (size.dem_bytes + size.extract_bytes) * share,
        PART: 1.0,
        PARTS: float(shape.parts),
    }
    return counts[term]


@dataclass(frozen=True)
class Model:
    """Factors of all terms of all steps, and bytes of the package."""

    #: By measure, step and term.
    factors: dict[str, dict[str, dict[str, float]]]
    #: Bytes of the package for a node and for a byte of the extract.
    package: tuple[float, float]

    def has(self, step: str) -> bool:
        """Whether this step was measured."""
        return step in self.factors["seconds"]

    def of_step(self, measure: str, step: str, size: Size, shape: Shape) -> float:
        """All parts of a step together."""
        if not self.has(step):
            return 0.0
        parts = shape.of_step(step)
        terms = self.factors[measure][step].items()
        return sum(factor * _count(term, size, 1 / parts, shape) * parts for term, factor in terms)

    def total(self, measure: str, size: Size, shape: Shape) -> float:
        """All steps together."""
        return sum(self.of_step(measure, step, size, shape) for step in STEPS)

    def package_bytes(self, size: Size) -> float:
        """Bytes of the package."""
        return self.package[0] * size.nodes + self.package[1] * size.extract_bytes


#: So much more does the error of a step's total count than that of a part: shares of work are estimates, and their errors cancel in the total.
_TOTAL = 30.0


def fit_model(runs: Sequence[Run]) -> Model:
    """The factors that fit all parts and all totals of these runs best. Errors count in proportion to what was measured, so small builds count, too."""
    factors: dict[str, dict[str, dict[str, float]]] = {}
    for measure, of_part in MEASURES.items():
        factors[measure] = {}
        for step, terms in STEPS.items():
            rows: list[list[float]] = []
            values: list[float] = []
            weights: list[float] = []
            measured = [(run, part) for run in runs for part in run.of_step(step)]
            # Below a hundredth of the largest, errors count the same.
            floor = max((of_part(part) for _, part in measured), default=0.0) / 100 or 1.0
            for run in runs:
                parts = run.of_step(step)
                shape = shape_of(run)
                of_parts = [[_count(term, run.size, part.share, shape) for term in terms] for part in parts]
                rows += of_parts
                values += [of_part(part) for part in parts]
                weights += [1 / max(of_part(part), floor) for part in parts]
                if len(parts) > 1:
                    total = sum(of_part(part) for part in parts)
                    rows.append([sum(column) for column in zip(*of_parts, strict=True)])
                    values.append(total)
                    weights.append(_TOTAL / max(total, floor))
            if rows:
                factors[measure][step] = dict(zip(terms, fit(rows, values, weights), strict=True))
    rows = [[run.size.nodes, run.size.extract_bytes] for run in runs]
    sizes = [run.package_bytes for run in runs]
    per_node, per_byte = fit(rows, sizes, [1 / max(size, 1.0) for size in sizes])
    return Model(factors, (per_node, per_byte))


@dataclass(frozen=True)
class Check:
    """A run, and what a model that has not seen it says of it."""

    run: Run
    measured: float
    predicted: float


def check(runs: Sequence[Run], measure: str) -> list[Check]:
    """Each run against the model of the others."""
    checks = []
    for run in runs:
        others = [other for other in runs if other is not run]
        if others:
            measured = sum(MEASURES[measure](part) for part in run.parts)
            checks.append(Check(run, measured, fit_model(others).total(measure, run.size, shape_of(run))))
    return checks


@dataclass(frozen=True)
class Forecast:
    """A build on so many workers of one core each."""

    workers: int
    shape: Shape
    core_seconds: float
    seconds: float
    #: Seconds in which only one worker has something to do.
    serial_seconds: float
    #: Bytes a second that the storage must give while tiles are made, without a limit of its own.
    bytes_per_second: float
    #: What a larger number of workers would not make faster: "", "roads", "top and merge" or "storage".
    limit: str


#: Parts are not made longer than this, so that little is lost with a worker; in seconds.
LONGEST_PART = 1200.0
#: Parts of a step for each worker, at least, so that the last ones end at about the same time.
PARTS_PER_WORKER = 8


def forecast(model: Model, size: Size, workers: int, storage: float) -> Forecast:
    """How long a build takes; ``storage`` is what the storage moves in all, in bytes a second."""

    def parts(step: str) -> int:
        work = model.of_step("seconds", step, size, Shape(1, 1, 1))
        return max(1, PARTS_PER_WORKER * workers, math.ceil(work / LONGEST_PART))

    shape = Shape(parts("heights"), parts("tiles"), min(workers, 64))

    def seconds(step: str) -> float:
        return model.of_step("seconds", step, size, shape)

    def moved(*steps: str) -> float:
        return sum(model.of_step(measure, step, size, shape) for measure in ("read", "written") for step in steps)

    def spread(step: str) -> float:
        # At the end of a step a worker waits for half a part, on average.
        return seconds(step) / workers * (1 + 0.5 / PARTS_PER_WORKER)

    chain = seconds("ways") / shape.shares + seconds("nodes") / shape.shares + seconds("roads")
    before = ("hashes", "ways", "nodes", "roads", "heights")
    heights = max(spread("heights") + seconds("top"), sum(map(seconds, before)) / workers)
    first = max(heights, chain, moved(*before) / storage)
    tiles = max(spread("tiles"), moved("tiles") / storage)
    last = max(seconds("merge"), moved("merge") / storage)
    total = first + tiles + last
    per_second = moved("tiles") / spread("tiles") if spread("tiles") > 0 else 0.0
    # The largest time that more workers do not shorten, if it is the larger half of all.
    fixed = {
        "storage": sum(time for time in (moved(*before) / storage, moved("tiles") / storage, moved("merge") / storage)),
        "roads": chain,
        "top and merge": seconds("top") + seconds("merge"),
    }
    limit = max(fixed, key=lambda name: fixed[name])
    serial = seconds("top") + seconds("merge") + max(0.0, chain - heights)
    return Forecast(workers, shape, model.total("seconds", size, shape), total, serial, per_second, limit if fixed[limit] > total / 2 else "")
