"""Builds of the sample on clusters of this machine: the same bytes as ``corniche build``, within the memory limit, without leftovers."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from distributed import Client, Future

from conftest import INPUTS, LEAST_WORK, PASS, Planned, none_left
from corniche_dask import build
from corniche_dask.cli import main
from corniche_dask.tasks import PartResult

Local = Callable[..., Client]
OPTIONS: dict[str, Any] = {"memory_bytes": 256 << 20, "least_work": LEAST_WORK}

#: The projection of the sample, for a file that does not name it.
UTM_32 = (
    'PROJCS["WGS_1984_UTM_Zone_32N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],'
    'PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],'
    'PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",9.0],PARAMETER["Scale_Factor",0.9996],'
    'PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]]'
)


@pytest.mark.parametrize(("workers", "threads"), [(1, 2), (2, 1), (4, 1)])
def test_any_number_of_workers_makes_the_bytes_of_a_build(workers: int, threads: int, planned: Planned, tmp_path: Path) -> None:
    store, package, report = (tmp_path / name for name in ["store", "out.pmtiles", "report.json"])
    options = ["--local", str(workers), "--threads-per-worker", str(threads), "--memory", "256M"]
    options += ["--corniche", planned.corniche, "--least-work", str(LEAST_WORK)]
    outputs = ["--store", str(store), "-o", str(package), "--report", str(report), "-q"]
    assert main(["build", *options, *planned.inputs, *outputs]) == 0
    assert package.read_bytes() == planned.bytes
    planned.check_store(store, tmp_path)
    none_left(str(store))
    told = json.loads(report.read_text())
    assert len({part["worker"] for part in told["parts"]}) == workers, "every worker made a part"
    assert all(part["was_made"] and part["cpu_seconds"] is not None and part["file_bytes"] for part in told["parts"])
    assert {part["threads"] for part in told["parts"]} == {threads}
    assert told["estimate"]["nodes"] == 1_000_000


def test_a_finished_store_is_only_merged(planned: Planned, tmp_path: Path, local: Local) -> None:
    store, first, second = (tmp_path / name for name in ["store", "first.pmtiles", "second.pmtiles"])
    client = local(2)
    build(client, planned.plan, str(store), str(first), **OPTIONS, corniche=planned.corniche)
    before = {path.name: path.stat() for path in (store / "parts").iterdir()}
    again = build(client, planned.plan, str(store), str(second), **OPTIONS, corniche=planned.corniche)
    assert [part.id for part in again.parts if part.was_made] == ["merge"]
    assert {path.name: path.stat() for path in (store / "parts").iterdir()} == before
    assert first.read_bytes() == second.read_bytes() == planned.bytes


class Twice:
    """A client that submits every part a second time, under another key, while the first may be running."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self.again: list[Future[Any]] = []

    def __getattr__(self, name: str) -> Any:
        return getattr(self._client, name)

    def submit(self, function: Any, task: Any, *more: Any, key: str, **options: Any) -> Any:
        first = self._client.submit(function, task, *more, key=key, **options)
        if hasattr(task, "job"):
            other = f"{key}-twice"
            self.again.append(self._client.submit(function, replace(task, key=other), *more, key=other, **options))
        return first


def test_every_part_made_twice_makes_the_same_bytes(planned: Planned, tmp_path: Path, local: Local) -> None:
    store, package = tmp_path / "store", tmp_path / "out.pmtiles"
    client = Twice(local(2, 2, memory_limit=0))
    options: dict[str, Any] = {**OPTIONS, "corniche": planned.corniche, "threads": 1, "slots": 2}
    summary = build(client, planned.plan, str(store), str(package), **options)  # type: ignore[arg-type]
    again: list[PartResult] = client.gather(client.again)
    assert len(again) == len(summary.parts) > 8
    assert all(part.error is None for part in again), again
    at_once = sum(one.was_made and other.was_made for one, other in zip(summary.parts, again, strict=True))
    assert at_once > 0, "no part was made by two processes at once"
    assert package.read_bytes() == planned.bytes
    planned.check_store(store, tmp_path)
    none_left(str(store))


def test_parts_that_differ_tenfold_stay_within_memory(corniche: str, tmp_path: Path, local: Local) -> None:
    """The sample, and a small square of heights far from it."""
    square = tmp_path / "square.asc"
    rows = [" ".join(str((column * 7 + row * 13) % 50) for column in range(20)) for row in range(20)]
    head = ["ncols 20", "nrows 20", "xllcorner 554000", "yllcorner 5190000", "cellsize 10", "NODATA_value -9999"]
    square.write_text("\n".join([*head, *rows]) + "\n")
    square.with_suffix(".prj").write_text(UTM_32)
    inputs = ["--dem", str(PASS / "pass-dem.tif"), str(square), "--osm", str(PASS / "pass.osm.pbf"), "--max-error", "1"]
    planned = Planned(corniche, tmp_path, inputs)
    store, package = tmp_path / "store", tmp_path / "out.pmtiles"
    options = {**OPTIONS, "least_work": 0.0, "slots": 1, "corniche": corniche}
    summary = build(local(2), planned.plan, str(store), str(package), **options)
    sizes = sorted(part.file_bytes or 0 for part in summary.parts if part.step == "tiles")
    assert sizes[-1] > 10 * sizes[0] > 0, sizes
    assert all(part.peak_bytes is not None for part in summary.parts)
    assert not summary.above_memory()
    assert package.read_bytes() == planned.bytes


def test_a_wrong_option_of_the_plan_is_told_by_corniche(corniche: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = ["--store", str(tmp_path / "s"), "-o", str(tmp_path / "o.pmtiles"), "--corniche", corniche]
    assert main(["build", "--local", "1", *INPUTS, "--no-such-option", *files]) == 2
    assert "--no-such-option" in capsys.readouterr().err
    assert main(["build", "--local", "1", "--dem", str(tmp_path / "none.tif"), *files]) == 2
    assert "none.tif" in capsys.readouterr().err


def test_a_store_of_another_plan_is_refused_once(planned: Planned, corniche: str, tmp_path: Path, local: Local) -> None:
    store, package = tmp_path / "store", tmp_path / "out.pmtiles"
    planned.run("part", str(planned.plan), "--store", str(store), "--step", "hashes")
    other = tmp_path / "other.json"
    planned.run("plan", "--dem", str(PASS / "pass-dem.tif"), "--max-error", "9", "-o", str(other))
    from corniche_dask import PartRefused

    with pytest.raises(PartRefused, match="another plan"):
        build(local(1), other, str(store), str(package), **OPTIONS, corniche=corniche)
    assert not package.exists()
