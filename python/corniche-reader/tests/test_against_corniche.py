"""All tiles against `corniche tile --json`, bit for bit."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

from corniche_reader import Package

REPOSITORY = Path(__file__).parents[3]
GOLDEN = [REPOSITORY / "crates/tileset/tests/data" / name for name in ("version-1.pmtiles", "version-1-degrees.pmtiles")]
DATA = Path(os.environ.get("CORNICHE_DATA", REPOSITORY.parent / "shared/data"))
PROGRAM = os.environ.get("CORNICHE")
REAL = {
    "portland": ("portland/portland-ned.tif", "portland/portland-central-filtered.osm.pbf"),
    "liechtenstein": ("liechtenstein/N47E009.hgt", "liechtenstein/liechtenstein-2013-08-03.osm.pbf"),
}
pytestmark = pytest.mark.skipif(not PROGRAM, reason="the environment variable CORNICHE does not name the program")


def compare(path: Path) -> None:
    with Package.open(path) as package:
        assert package.tiles()
        for z, x, y in package.tiles():
            tile = package.tile(z, x, y)
            expected = json.loads(subprocess.check_output([str(PROGRAM), "tile", str(path), f"{z}/{x}/{y}", "--json"]))
            tin, terrain = expected.get("tin"), tile.terrain
            assert (terrain is None) == (tin is None)
            if terrain is not None:
                assert np.array_equal(terrain.positions, np.array(tin["vertices"])), (z, x, y)
                assert np.array_equal(terrain.triangles, np.array(tin["triangles"])), (z, x, y)
                assert np.abs(terrain.normals - np.array(tin["normals"])).max() < 1e-15
                assert terrain.geometric_error_m == expected["geometric_error_m"]
                assert list(terrain.height_range_m) == expected["height_range_m"]
                assert terrain.uncovered_nodes == expected["uncovered_nodes"]
            for road, other in zip(tile.roads, expected.get("roads_geo") or [], strict=True):
                assert (road.way_id, road.part, road.road_class) == (other["way_id"], other["part"], other["frc"])
                assert np.array_equal(road.vertices, np.array(other["line"])), (z, x, y, road.way_id)
            for known, other in zip(tile.attributes, expected.get("attributes") or [], strict=True):
                assert (known.way_id, known.form, known.structure, known.layer, known.oneway) == tuple(
                    other[key] for key in ("way_id", "form", "structure", "layer", "oneway")
                )
                assert (known.name, known.reference, known.surface) == tuple(other[key] or "" for key in ("name", "ref", "surface"))


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_the_golden_packages_are_read_as_corniche_reads_them(path):
    compare(path)


@pytest.mark.parametrize("name", REAL)
def test_real_packages_are_read_as_corniche_reads_them(name, tmp_path):
    dem, osm = (DATA / part for part in REAL[name])
    if not (dem.exists() and osm.exists()):
        pytest.skip(f"there is no {dem}")
    package = tmp_path / f"{name}.pmtiles"
    subprocess.run([str(PROGRAM), "build", "--dem", str(dem), "--osm", str(osm), "--quiet", "-o", str(package)], check=True)
    compare(package)
