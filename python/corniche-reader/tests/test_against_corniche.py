"""Compares all tiles with `corniche tile --json`, bit for bit."""

from __future__ import annotations

import csv
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

from corniche_reader import Package

REPOSITORY = Path(__file__).parents[3]
GOLDEN = [REPOSITORY / "crates/tileset/tests/data" / name for name in ("version-2.pmtiles", "version-2-degrees.pmtiles")]
DATA = Path(os.environ.get("CORNICHE_DATA", REPOSITORY.parent / "shared/data"))
PROGRAM = os.environ.get("CORNICHE")
REAL = {
    "portland": ("portland/portland-ned.tif", "portland/portland-central-filtered.osm.pbf", "1.8"),
    "liechtenstein": ("liechtenstein/N47E009.hgt", "liechtenstein/liechtenstein-2013-08-03.osm.pbf", "15.7"),
}
"""Elevation, extract and error bound: a quarter of the cell, because all triangles are read in Python."""
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
                structure = "bridge" if known.bridge else "tunnel" if known.tunnel else "ground"
                oneway = {"no": "no", "forward": "yes", "backward": "-1"}[other["oneway"]]
                assert (structure, known.oneway, known.width) == (other["structure"], oneway, other["width_m"])
                assert not (known.bridge and known.tunnel)
                for key in ("way_id", "form", "layer", "name", "ref", "surface", "highway", "lanes", "maxspeed", "sac_scale", "tracktype"):
                    assert getattr(known, key) == other[key], (z, x, y, known.way_id, key)
            layers = {layer["layer"]: layer["objects"] for layer in expected.get("layers") or []}
            for layer, objects in tile.layers.items():
                for of, other in zip(objects, layers.pop(layer, []), strict=True):
                    assert (of.osm_type, of.osm_id, of.class_id) == (other["object"], other["id"], other["class"])
                    assert of.attributes == other.get("attributes", {}), (z, x, y, layer, of.osm_id)
                    shapes = other["polygons"] if of.points is None else [[other["line"] if "line" in other else [other["point"]]]]
                    assert [[ring.tolist() for ring in polygon] for polygon in of.polygons or [[of.points]]] == shapes
            assert not layers


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_the_golden_packages_are_read_as_corniche_reads_them(path):
    compare(path)


@pytest.mark.parametrize("name", REAL)
def test_real_packages_are_read_as_corniche_reads_them(name, tmp_path):
    *files, bound = REAL[name]
    dem, osm = (DATA / part for part in files)
    if not (dem.exists() and osm.exists()):
        pytest.skip(f"there is no {dem}")
    package = tmp_path / f"{name}.pmtiles"
    subprocess.run([str(PROGRAM), "build", "--dem", str(dem), "--osm", str(osm), "--max-error", bound, "--quiet", "-o", str(package)], check=True)
    compare(package)


def exported(path: Path, folder: Path) -> list[dict[str, str]]:
    """The rows of `corniche export roads --pieces`."""
    rows = folder / "pieces.csv"
    subprocess.run([str(PROGRAM), "export", "roads", str(path), "--pieces", "--quiet", "-o", str(rows)], check=True)
    with open(rows, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_fields_are_those_of_exports(path, tmp_path):
    rows = {(row["tile"], row["way_id"], row["part"]): row for row in exported(path, tmp_path)}
    assert rows
    with Package.open(path) as package:
        for name in (name for name in package.tiles() if name[0] == package.grid.max_level):
            tile = package.tile(*name)
            for road in tile.roads:
                fields = tile.fields(road)
                row = rows.pop((fields["tile"], str(fields["way_id"]), str(fields["part"])))
                assert [key for key in row if key in fields] == list(fields)
                for key, value in fields.items():
                    said = "" if value is None else str(int(value)) if isinstance(value, bool) else str(value)
                    assert float(row[key]) == value if key == "width" and value else row[key] == said, (fields, key)
    assert not rows


@pytest.mark.parametrize(("path", "level"), list(zip(GOLDEN, (2, 0), strict=True)), ids=("projected", "degrees"))
def test_places_and_heights_are_those_of_profiles(path, level, tmp_path):
    with Package.open(path) as package:
        roads = [road for name in package.tiles() if name[0] == level for road in package.tile(*name).roads]
    profile = tmp_path / "profile.csv"
    ways = ",".join(sorted({str(road.way_id) for road in roads}))
    command = [str(PROGRAM), "profile", str(path), "--way", ways, "--level", str(level), "--csv", str(profile), "--quiet"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(profile, encoding="utf-8", newline="") as file, Package.open(path) as package:
        rows = list(csv.DictReader(file))
        places = np.array([[float(row["lon"]), float(row["lat"])] for row in rows])
        found = package.degrees(np.concatenate([road.vertices for road in roads]))
        # Profiles have eight decimals.
        away = np.abs(places[:, None, :] - found[None, :, :]).max(axis=2).min(axis=1)
        assert away.max() < 6e-9
        # The rounded position is within a millimetre, and on a slope of 45 degrees the height as
        # well.
        for row, (lon, lat) in list(zip(rows, places, strict=True))[::5]:
            height = package.height_at(lon, lat, None if level == package.grid.max_level else level)
            assert height is not None and abs(height - float(row["height_m"])) < 0.01, row
        assert package.height_at(0.0, 0.0) is None and package.height_at(-170.0, -40.0) is None


def test_the_ground_has_its_own_heights_at_its_vertices():
    with Package.open(GOLDEN[0]) as package:
        for level in range(package.grid.max_level + 1):
            for name in (name for name in package.tiles() if name[0] == level):
                positions = package.tile(*name).terrain.positions[::97]
                for (lon, lat), z in zip(package.degrees(positions), positions[:, 2], strict=True):
                    # On the border of two tiles, both have this vertex.
                    assert abs(package.height_at(lon, lat, level) - z) < 0.01, (name, lon, lat)
