"""The cost of each step as a sum of terms: per node, per byte of the extract, per byte of input, per part.

A step has the terms that its work depends on; the factors are fitted to all measured parts. The number of nodes of a part is unknown, but its share
of the estimated work of its step is known.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from .fit import fit
from .runs import Part, Run, Size

# : The units that terms count: nodes and bytes of the extract or of all inputs, in proportion to
# the part's share of the work; parts.
NODE, EXTRACT, INPUT, PART, PARTS = "node", "extract byte", "input byte", "part", "part of the build"

# : The steps, in their order, with the terms of their cost. Top and merge read some bytes of every
# part.
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
#: Steps that consist of one part: more workers do not shorten them.
SERIAL = ("hashes", "roads", "top", "merge")

# : The measures of a part, by name. Steps of one process are measured in wall time, which includes
# waiting for the disk.
MEASURES: dict[str, Callable[[Part], float]] = {
    "seconds": lambda part: max(part.cpu_seconds, part.seconds) if part.step in SERIAL else part.cpu_seconds,
    "read": lambda part: part.read_bytes,
    "written": lambda part: part.written_bytes,
    "stored": lambda part: part.stored_bytes,
}


@dataclass(frozen=True)
class Shape:
    """The number of parts into which a build is divided."""

    heights: int
    tiles: int
    shares: int

    @property
    def parts(self) -> int:
        """The number of parts that top and merge read."""
        return self.heights + self.tiles

    def of_step(self, step: str) -> int:
        """The number of parts of one step."""
        return {"heights": self.heights, "tiles": self.tiles, "ways": self.shares, "nodes": self.shares}.get(step, 1)


def shape_of(run: Run) -> Shape:
    """The shape of a measured build."""
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
    """The factors of all terms of all steps, and of the size of the package."""

    #: By measure, step and term.
    factors: dict[str, dict[str, dict[str, float]]]
    #: Bytes of the package per node and per byte of the extract.
    package: tuple[float, float]

    def has(self, step: str) -> bool:
        """Whether this step was measured."""
        return step in self.factors["seconds"]

    def of_step(self, measure: str, step: str, size: Size, shape: Shape) -> float:
        """The cost of all parts of a step together."""
        if not self.has(step):
            return 0.0
        parts = shape.of_step(step)
        terms = self.factors[measure][step].items()
        return sum(factor * _count(term, size, 1 / parts, shape) * parts for term, factor in terms)

    def total(self, measure: str, size: Size, shape: Shape) -> float:
        """The cost of all steps together."""
        return sum(self.of_step(measure, step, size, shape) for step in STEPS)

    def package_bytes(self, size: Size) -> float:
        """The size of the package in bytes."""
        return self.package[0] * size.nodes + self.package[1] * size.extract_bytes


# : The weight of the error of a step's total, where a part has weight 1: shares of work are
# estimates, whose errors cancel in the total.
_TOTAL = 30.0


def fit_model(runs: Sequence[Run]) -> Model:
    """Fits the factors to all parts and all totals of these runs. Errors count relative to the measured value, so small builds count, too."""
    factors: dict[str, dict[str, dict[str, float]]] = {}
    for measure, of_part in MEASURES.items():
        factors[measure] = {}
        for step, terms in STEPS.items():
            rows: list[list[float]] = []
            values: list[float] = []
            weights: list[float] = []
            measured = [(run, part) for run in runs for part in run.of_step(step)]
            # Below a hundredth of the largest value, errors count in absolute terms.
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
    """A run, and the prediction of a model that was fitted without this run."""

    run: Run
    measured: float
    predicted: float


def check(runs: Sequence[Run], measure: str) -> list[Check]:
    """Compares each run with the model of the others."""
    checks = []
    for run in runs:
        others = [other for other in runs if other is not run]
        if others:
            measured = sum(MEASURES[measure](part) for part in run.parts)
            checks.append(Check(run, measured, fit_model(others).total(measure, run.size, shape_of(run))))
    return checks


@dataclass(frozen=True)
class Forecast:
    """The forecast for a build on a number of workers of one core each."""

    workers: int
    shape: Shape
    core_seconds: float
    seconds: float
    #: Seconds in which only one worker has work.
    serial_seconds: float
    # : Bytes per second that the storage must deliver while tiles are built, if it is not the limit
    # itself.
    bytes_per_second: float
    # : The part of the build that more workers would not make faster: "", "roads", "top and merge"
    # or "storage".
    limit: str


#: Seconds of the longest part, so that little is lost with a worker.
LONGEST_PART = 1200.0
#: The least number of parts of a step per worker, so that the last ones end at about the same time.
PARTS_PER_WORKER = 8


def forecast(model: Model, size: Size, workers: int, storage: float) -> Forecast:
    """Forecasts the duration of a build; ``storage`` is the total throughput of the storage, in bytes per second."""

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
    # The limit is the largest time that more workers do not shorten, if it is more than half of the
    # total.
    fixed = {
        "storage": moved(*before, "tiles", "merge") / storage,
        "roads": chain,
        "top and merge": seconds("top") + seconds("merge"),
    }
    limit = max(fixed, key=lambda name: fixed[name])
    serial = seconds("top") + seconds("merge") + max(0.0, chain - heights)
    return Forecast(workers, shape, model.total("seconds", size, shape), total, serial, per_second, limit if fixed[limit] > total / 2 else "")
