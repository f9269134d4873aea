"""The cost model finds the factors from which measured builds were generated."""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

import pytest

from corniche_dask.cli import main
from corniche_dask.cost.fit import fit
from corniche_dask.cost.model import check, fit_model, forecast, shape_of
from corniche_dask.cost.runs import Size, read_runs

#: Seconds per million nodes, per MB of extract, and per part.
HEIGHTS, TILES, ROAD, START = 0.2, 3.0, 1.5, 0.25


def report(folder: Path, name: str, nodes: float, extract: float, count: int, **more: Any) -> str:
    """The report of a build whose parts, of unequal size, have exactly this cost."""
    sizes = [1.0 + number % 5 for number in range(count)]
    shares = [size / sum(sizes) for size in sizes]

    def part(step: str, number: int, work: float, seconds: float, stored: float) -> dict[str, Any]:
        told = {"id": f"{step}-{number}", "step": step, "work": work, "was_made": True, "cpu_seconds": seconds, "seconds": seconds * 1.1}
        return {**told, "read_bytes": 2 * stored, "written_bytes": stored, "file_bytes": stored}

    made = [part("hashes", 0, 1.0, START + (2 * nodes + extract) / 1e9, 100)]
    made += [part("roads", 0, 1.0, START + ROAD * extract / 1e6, 3 * extract)]
    for number, share in enumerate(shares):
        million, mega = nodes * share / 1e6, extract * share / 1e6
        made.append(part("heights", number, share * 10, START + HEIGHTS * million, 4 * nodes * share))
        made.append(part("tiles", number, share * 70, START + TILES * million + ROAD * mega, nodes * share + extract * share))
    made += [part("top", 0, 1.0, 0.1 + 0.01 * 2 * count, 1000), part("merge", 0, 1.0, 1e-8 * nodes + 0.002 * 2 * count, nodes + extract)]
    value = {"version": 1, "estimate": {"nodes": nodes}, "input_bytes": {"dem": 2 * nodes, "osm": extract}, "parts": made, **more}
    path = folder / f"{name}.json"
    path.write_text(json.dumps(value))
    return str(path)


@pytest.fixture
def reports(tmp_path: Path) -> list[str]:
    """Reports of three sizes; roads do not grow in proportion to nodes."""
    return [report(tmp_path, "small", 1e6, 2e6, 7), report(tmp_path, "large", 84e6, 12e6, 40), report(tmp_path, "medium", 12e6, 9e6, 16)]


def test_factors_are_found(reports: list[str]) -> None:
    model = fit_model(read_runs(reports))
    seconds = model.factors["seconds"]
    assert seconds["heights"]["node"] * 1e6 == pytest.approx(HEIGHTS)
    assert seconds["tiles"]["node"] * 1e6 == pytest.approx(TILES)
    assert seconds["tiles"]["extract byte"] * 1e6 == pytest.approx(ROAD)
    assert seconds["tiles"]["part"] == pytest.approx(START)
    # By wall time, which is longer than the processor time here.
    assert seconds["roads"]["extract byte"] * 1e6 == pytest.approx(1.1 * ROAD)
    assert seconds["top"]["part of the build"] == pytest.approx(0.011)
    assert model.package_bytes(Size(5e6, 1e6, 0)) == pytest.approx(6e6)


def test_each_build_is_predicted_from_the_others(reports: list[str]) -> None:
    runs = read_runs(reports)
    assert [run.name for run in runs] == ["small", "medium", "large"]
    for told in check(runs, "seconds"):
        assert told.predicted == pytest.approx(told.measured, rel=0.02)


def test_a_model_that_is_wrong_is_seen_by_its_check(tmp_path: Path, reports: list[str]) -> None:
    """A build whose tiles took twice as long as those of the others."""
    value = json.loads(Path(reports[1]).read_text())
    for part in value["parts"]:
        part["cpu_seconds"] *= 2
    Path(reports[1]).write_text(json.dumps(value))
    large = next(told for told in check(read_runs(reports), "seconds") if told.run.name == "large")
    assert large.predicted < 0.6 * large.measured


def test_more_workers_are_faster_until_one_worker_alone_decides(reports: list[str]) -> None:
    runs = read_runs(reports)
    model, size = fit_model(runs), Size(11e9, 0.15e9, 22e9)
    told = [forecast(model, size, workers, storage=1e12) for workers in (1, 4, 16, 64, 256, 1024, 4096)]
    assert told[0].seconds == pytest.approx(told[0].core_seconds, rel=0.1)
    assert all(more.seconds < fewer.seconds for fewer, more in zip(told[:4], told[1:4], strict=False))
    assert told[0].limit == "" and told[-1].limit in ("roads", "top and merge")
    alone = model.of_step("seconds", "top", size, told[-1].shape) + model.of_step("seconds", "merge", size, told[-1].shape)
    assert told[-1].seconds > alone


def test_slow_storage_is_the_limit(reports: list[str]) -> None:
    model, size = fit_model(read_runs(reports)), Size(41e9, 0.5e9, 82e9)
    slow = forecast(model, size, 256, storage=1e6)
    moved = model.total("read", size, slow.shape) + model.total("written", size, slow.shape)
    assert slow.limit == "storage" and slow.seconds == pytest.approx(moved / 1e6, rel=0.2)


def test_one_size_in_more_parts_has_the_same_nodes(reports: list[str]) -> None:
    runs = read_runs(reports)
    model, run = fit_model(runs), runs[-1]
    shape = shape_of(run)
    assert shape.tiles == 40
    measured = sum(part.cpu_seconds for part in run.of_step("tiles"))
    assert model.of_step("seconds", "tiles", run.size, shape) == pytest.approx(measured)


@pytest.mark.parametrize("seed", range(5))
def test_least_squares_find_what_no_other_coefficients_beat(seed: int) -> None:
    """Also if the best unconstrained coefficient would be negative."""
    chance = random.Random(seed)
    rows = [[chance.uniform(0, 1e9), chance.uniform(0, 1e3), 1.0] for _ in range(30)]
    values = [row[0] * 2e-9 - row[1] * 1e-3 + 5 + chance.gauss(0, 0.1) for row in rows]
    weights = [1.0] * len(rows)

    def error(coefficients: list[float]) -> float:
        return sum((sum(a * b for a, b in zip(row, coefficients, strict=True)) - value) ** 2 for row, value in zip(rows, values, strict=True))

    found = fit(rows, values, weights)
    assert min(found) >= 0 and found[1] == 0
    for _ in range(200):
        other = [max(0.0, value + chance.gauss(0, 0.01) * scale) for value, scale in zip(found, [1e-9, 1e-3, 1], strict=True)]
        assert error(found) <= error(other) + 1e-9


def test_the_table(reports: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cost", *reports, "--price", "0.05", "--storage", "2e9"]) == 0
    text = capsys.readouterr().out
    for piece in ["| measured |", "tiles, for a million nodes | 3 |", "**Utah at 5 m**: 11.0 billion nodes", "**Switzerland at 1 m**", "| price |"]:
        assert piece in text, text
    tables = [line for line in text.splitlines() if line.startswith("|")]
    assert len({line.count("|") for line in tables if "workers of one core" in line}) == 1
    assert main(["cost", *reports, "--target", "here,1e6,0"]) == 0
    assert "**here**: 0.0 billion" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"version": 2}, "version 2"),
        ({"estimate": None}, "number of nodes"),
        ({"parts": []}, "not finished"),
        ({"input_bytes": 5}, "is not a report"),
    ],
)
def test_reports_that_cannot_be_used(change: dict[str, Any], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cost", report(tmp_path, "one", 1e6, 1e6, 3, **change)]) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(
    ("change", "told"),
    [({"was_made": False}, "a store that is empty"), ({"file_bytes": None}, "a store and a package in folders")],
)
def test_parts_that_say_too_little_cannot_be_used(
    change: dict[str, Any], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = Path(report(tmp_path, "one", 1e6, 1e6, 3))
    value = json.loads(path.read_text())
    value["parts"][2].update(change)
    path.write_text(json.dumps(value))
    assert main(["cost", str(path)]) == 2
    assert told in capsys.readouterr().err


def test_two_sizes_are_not_enough(reports: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cost", reports[0], reports[1], reports[1]]) == 2
    assert "reports of 2 sizes" in capsys.readouterr().err


def test_a_model_that_does_not_fit_is_not_to_be_trusted(tmp_path: Path, reports: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cost", *reports]) == 0
    assert "Do not trust" not in capsys.readouterr().out
    value = json.loads(Path(reports[-1]).read_text())
    for part in value["parts"]:
        part["cpu_seconds"] *= 5
    odd = tmp_path / "odd.json"
    odd.write_text(json.dumps(value))
    assert main(["cost", *reports[:-1], str(odd)]) == 0
    assert "Do not trust" in capsys.readouterr().out
