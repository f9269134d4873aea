"""Compares the package of the repository with stored numbers, and reads corrupted copies of it."""

from __future__ import annotations

import io
import zlib
from pathlib import Path

import numpy as np
import pytest
from encoding import package_of, payload

from corniche_reader import ContainerError, Package, PayloadError, ReadError, UnknownTile
from corniche_reader.container import tile_number, tile_of

GOLDEN = Path(__file__).parents[3] / "crates/tileset/tests/data/version-2.pmtiles"
ROOT = (0, 0, 0)
#: CRC-32 of the decoded values; `corniche tile --json` gives the same.
SUMS = {"positions": 0x51A80049, "triangles": 0x2E36449E, "normals": 0x2F4CC374, "roads": 0x63973D00}


def test_ids_of_tiles_go_there_and_back():
    assert [tile_of(n) for n in range(5)] == [(0, 0, 0), (1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0)]
    assert all(tile_number(*tile_of(n)) == n for n in range(2000))


def test_the_golden_package_reads_as_it_did():
    sums = {"positions": 0, "triangles": 0, "normals": 0, "roads": 0}
    with Package.open(GOLDEN) as package:
        tiles = [package.tile(*name) for name in package.tiles()]
    for tile in tiles:
        sums["positions"] = zlib.crc32(tile.terrain.positions.astype("<f8").tobytes(), sums["positions"])
        sums["triangles"] = zlib.crc32(tile.terrain.triangles.astype("<i8").tobytes(), sums["triangles"])
        sums["normals"] = zlib.crc32(tile.terrain.normal_codes.tobytes(), sums["normals"])
        for road in tile.roads:
            sums["roads"] = zlib.crc32(np.ascontiguousarray(road.vertices, "<f8").tobytes(), sums["roads"])
    assert len(tiles) == 9
    assert sum(len(tile.terrain.triangles) for tile in tiles) == 1469 + 3883 + 10884
    assert sums == SUMS


def test_a_tile_that_is_not_there_is_named():
    with Package.open(GOLDEN) as package, pytest.raises(UnknownTile, match="no tile 1/1/1"):
        package.tile(1, 1, 1)


def test_packages_and_tiles_of_version_1_are_refused():
    with Package.open(GOLDEN) as package:
        old = package_of(package, ROOT, payload(ROOT, package.tile(*ROOT).sections, version=1))
        package.metadata["corniche"]["format_version"] = 1
        older = package_of(package, ROOT, b"CRNT")
    with Package(io.BytesIO(old)) as package, pytest.raises(PayloadError, match="has version 1 of the format"):
        package.tile(*ROOT)
    with pytest.raises(ContainerError, match="has version 1 of the format; this reader knows version 2"):
        Package(io.BytesIO(older))


def places_of(part: str) -> range:
    data = GOLDEN.read_bytes()
    words = [int.from_bytes(data[at : at + 8], "little") for at in range(8, 72, 8)]
    if part == "header":
        return range(0, 80)
    if part == "directory":
        return range(words[0] + 10, words[0] + words[1])
    if part == "metadata":
        return range(words[2] + 10, words[2] + words[3], 97)
    with Package.open(GOLDEN) as package:
        place = package._places[ROOT]
    return range(place.offset, place.offset + place.length, 7)


@pytest.mark.parametrize("part", ["header", "directory", "metadata", "payload"])
def test_flipped_bytes_are_refused_or_change_nothing(part):
    """The bytes that may change: the offset of leaf directories if there are none, and names and times in gzip headers."""
    data = bytearray(GOLDEN.read_bytes())
    with Package.open(GOLDEN) as package:
        metadata, places = package.metadata, package._places
    places_in_file, harmless = places_of(part), 0
    for at in places_in_file:
        data[at] ^= 0x10
        try:
            package = Package(io.BytesIO(bytes(data)))
            package.tile(*ROOT)
        except ReadError:
            pass
        else:
            harmless += 1
            assert part != "payload" and (package.metadata, package._places) == (metadata, places), at
        data[at] ^= 0x10
    assert harmless <= 10 < len(places_in_file)


def test_files_that_are_cut_are_refused():
    data = GOLDEN.read_bytes()
    for length in (0, 100, 127, 20_000, len(data) - 1):
        with pytest.raises(ReadError):
            package = Package(io.BytesIO(data[:length]))
            for name in package.tiles():
                package.tile(*name)
