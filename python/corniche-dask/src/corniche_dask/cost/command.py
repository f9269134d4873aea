"""``corniche-dask cost``: a table in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from corniche.errors import UsageError

from ..progress import duration
from ..summary import bytes_text
from .model import MEASURES, STEPS, Model, Shape, check, fit_model, forecast, shape_of
from .runs import Run, Size, read_runs

#: Numbers of workers in the tables.
WORKERS = (1, 4, 16, 64, 256, 1024, 4096)
#: With fewer sizes, a build cannot be predicted from the others.
_FEWEST_SIZES = 3
#: A model is reported as unusable if a build is off by more than this share.
_TRUSTED = 0.3
# : Areas of countries divided by the area of a cell; extracts have about the size of those that
# Geofabrik offers in 2025.
TARGETS = ("Utah at 5 m,11.0e9,0.15e9", "Switzerland at 1 m,41.3e9,0.5e9")


def add_command(commands: Any) -> None:
    """Adds the command to a parser's commands."""
    parser = commands.add_parser(
        "cost",
        allow_abbrev=False,
        help="estimate the cost of larger builds, from reports of measured ones",
        description="Fits the cost of each step to measured builds, checks it against each of them, and extrapolates. Prints Markdown.",
    )
    parser.add_argument("runs", metavar="REPORT.json", nargs="+", help="reports of corniche-dask build --report; at least three sizes")
    parser.add_argument(
        "--target",
        metavar="NAME,NODES,EXTRACT[,DEM]",
        action="append",
        help=f"a build to extrapolate to: nodes, bytes of the extract, bytes of the DEM [default: as many per node as measured]; {TARGETS}",
    )
    parser.add_argument("--storage", metavar="BYTES", type=float, default=1e9, help="total throughput of the storage, in bytes/s [default: 1e9]")
    parser.add_argument("--price", metavar="P", type=float, help="price of one core-hour, in any currency; adds a column")


def run(reports: Sequence[str], targets: Sequence[str] | None, storage: float, price: float | None) -> str:
    """Returns the Markdown."""
    if storage <= 0:
        raise UsageError("--storage must be above 0")
    runs = read_runs(reports)
    sizes = len({run.size for run in runs})
    if sizes < _FEWEST_SIZES:
        raise UsageError(f"these are reports of {sizes} sizes; the model needs builds of {_FEWEST_SIZES} sizes, so that it can be checked")
    model = fit_model(runs)
    sections = [_measured(runs), _factors(model), _checks(runs)]
    for text in targets or TARGETS:
        name, size = _target(text, runs[-1])
        sections.append(_forecasts(name, size, model, storage, price))
    return "\n\n".join(sections)


def _target(text: str, largest: Run) -> tuple[str, Size]:
    name, *numbers = text.split(",")
    try:
        nodes, extract, *dem = (float(number) for number in numbers)
        if not nodes > 0 or extract < 0 or len(dem) > 1:
            raise ValueError(numbers)
    except ValueError as error:
        raise UsageError(f"--target {text!r} is not valid; write NAME,NODES,EXTRACT[,DEM]") from error
    return name, Size(nodes, extract, dem[0] if dem else largest.size.dem_bytes / largest.size.nodes * nodes)


def _markdown(heading: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [heading, ["---"] + ["---:"] * (len(heading) - 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def _measured(runs: Sequence[Run]) -> str:
    rows = []
    for measured in runs:
        shape = shape_of(measured)
        moved = sum(part.read_bytes + part.written_bytes for part in measured.parts)
        rows.append(
            [
                measured.name,
                f"{measured.size.nodes / 1e6:.1f} M",
                bytes_text(measured.size.extract_bytes),
                f"{shape.heights} + {shape.tiles}",
                f"{sum(part.cpu_seconds for part in measured.parts):.1f} s",
                bytes_text(moved),
                bytes_text(sum(part.stored_bytes for part in measured.parts)),
                bytes_text(measured.package_bytes),
            ]
        )
    heading = ["measured", "nodes", "extract", "parts (heights + tiles)", "processors", "read and written", "stored", "package"]
    return _markdown(heading, rows)


#: The units for which factors are shown, and their scale.
_UNITS = {"node": ("million nodes", 1e6), "extract byte": ("MB of extract", 1e6), "input byte": ("GB of input", 1e9), "part": ("part", 1.0)}


def _factors(model: Model) -> str:
    rows = []
    for step in STEPS:
        if not model.has(step):
            continue
        for term in STEPS[step]:
            unit, scale = _UNITS.get(term, (term, 1.0))
            factors = [model.factors[measure][step][term] * scale for measure in MEASURES]
            if any(factors):
                rows.append([f"{step}, for a {unit}", f"{factors[0]:.4g}", *(bytes_text(factor) for factor in factors[1:])])
    for what, factor in zip(("million nodes", "MB of extract"), model.package, strict=True):
        rows.append([f"package, for a {what}", "", "", "", bytes_text(factor * 1e6)])
    return _markdown(["fitted", "seconds on a core", "read", "written", "stored"], rows)


def _checks(runs: Sequence[Run]) -> str:
    rows, most = [], 0.0
    for seconds, stored in zip(check(runs, "seconds"), check(runs, "stored"), strict=True):
        most = max(most, abs(seconds.predicted / seconds.measured - 1)) if seconds.measured > 0 else most
        rows.append(
            [
                seconds.run.name,
                f"{seconds.measured:.1f} s",
                f"{seconds.predicted:.1f} s",
                _difference(seconds.measured, seconds.predicted),
                bytes_text(stored.measured),
                bytes_text(stored.predicted),
                _difference(stored.measured, stored.predicted),
            ]
        )
    heading = ["from the other builds alone", "core seconds measured", "predicted", "off by", "stored, measured", "predicted", "off by"]
    table = _markdown(heading, rows)
    if most > _TRUSTED:
        table += (
            f"\n\n**Do not trust what follows**: a build differs by {100 * most:.0f} % from the prediction of the others. Measure larger "
            "builds, with the same settings, on a quiet machine."
        )
    return table


def _difference(measured: float, predicted: float) -> str:
    return f"{100 * (predicted / measured - 1):+.1f} %" if measured > 0 else ""


def _forecasts(name: str, size: Size, model: Model, storage: float, price: float | None) -> str:
    one = forecast(model, size, 1, storage)
    moved = model.total("read", size, one.shape) + model.total("written", size, one.shape)
    text = (
        f"**{name}**: {size.nodes / 1e9:.1f} billion nodes, {bytes_text(size.extract_bytes)} of extract, {bytes_text(size.dem_bytes)} of DEM; "
        f"{one.core_seconds / 3600:.1f} core-hours, {bytes_text(moved)} read and written, {bytes_text(model.total('stored', size, one.shape))} "
        f"stored, a package of {bytes_text(model.package_bytes(size))}. Storage that moves {bytes_text(storage)}/s."
    )
    rows = []
    for workers in WORKERS:
        told = forecast(model, size, workers, storage)
        row = [
            f"{workers}",
            f"{told.shape.parts}",
            duration(told.seconds),
            f"{workers * told.seconds / 3600:.1f}",
            f"{100 * told.core_seconds / (workers * told.seconds):.0f} %",
            duration(told.serial_seconds),
            f"{bytes_text(told.bytes_per_second)}/s",
            told.limit,
        ]
        rows.append(row + ([f"{workers * told.seconds / 3600 * price:.2f}"] if price is not None else []))
    heading = ["workers of one core", "parts", "time", "core-hours held", "busy", "one worker alone", "tiles move", "limit"]
    return text + "\n\n" + _markdown(heading + (["price"] if price is not None else []), rows) + "\n\n" + _limits(size, model, storage)


def _limits(size: Size, model: Model, storage: float) -> str:
    """The numbers of workers from which something else limits the speed."""
    shape = Shape(64, 64, 64)
    parallel = sum(model.of_step("seconds", step, size, shape) for step in ("heights", "tiles", "ways", "nodes"))
    alone = {step: model.of_step("seconds", step, size, shape) for step in ("roads", "top", "merge") if model.has(step)}
    tiles = model.of_step("seconds", "tiles", size, shape)
    moved = model.of_step("read", "tiles", size, shape) + model.of_step("written", "tiles", size, shape)
    told = [f"with {shape.parts} parts, {step} takes {duration(seconds)} on one worker" for step, seconds in alone.items()]
    if sum(alone.values()) > 0:
        told.append(f"all steps of one worker together take as long as the others on {parallel / sum(alone.values()):.0f} workers")
    if moved > 0:
        told.append(f"the storage is busy with {storage / (moved / tiles):.0f} workers")
    return "; ".join(told) + "."
