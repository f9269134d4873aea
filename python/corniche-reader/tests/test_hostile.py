"""For any manifest, the reader opens the package or raises one of its own errors, within a time limit."""

from __future__ import annotations

import functools
import gzip
import io
import json
import os
import signal
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from corniche_reader import Package, ReadError

GOLDEN = Path(__file__).parents[3] / "crates/tileset/tests/data/version-2.pmtiles"
#: The values that replace a number, as JSON.
HOSTILE = [
    "0", "-0.0", "-1", "1", "0.3", "5e-324", "1e-320", "1e308", "-1e308", "1e400", "NaN", "-Infinity", "4294967296",
    "9223372036854775808", "1" + "0" * 400, "1" + "0" * 5000, "null", "true", '""', '"x"', "[]", "{}", "[1]",
]  # fmt: skip
#: The parts of the manifest from which this reader takes numbers.
USED = ("frame", "vertical", "coordinates")
MOST_SECONDS = 20
#: Tiles are decoded once with each grid, because Python is slow.
GRIDS: set[object] = set()


def with_metadata(text: bytes) -> bytes:
    """The golden package with other metadata at its end, otherwise unchanged."""
    data = bytearray(GOLDEN.read_bytes())
    packed = gzip.compress(text, mtime=0)
    # Any bytes are allowed between the parts of a file.
    data[24:40] = len(data).to_bytes(8, "little") + len(packed).to_bytes(8, "little")
    return bytes(data) + packed


@functools.cache
def golden_text() -> str:
    with Package.open(GOLDEN) as package:
        return json.dumps(package.metadata)


def golden_metadata() -> dict[str, Any]:
    return json.loads(golden_text())


def numbers(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The paths of numbers; in a list only the first items, which represent the others."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from numbers(inner, (*path, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value[:2]):
            yield from numbers(inner, (*path, index))
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path


def use(data: bytes) -> None:
    """Calls every method of a package; errors of the reader are allowed."""
    try:
        package = Package(io.BytesIO(data))
        package.degrees([package.grid.origin_m])
        if package.grid not in GRIDS:
            GRIDS.add(package.grid)
            tile = package.tile(0, 0, 0)
            package.degrees(tile.terrain.positions[:3])
        package.height_at(9.6, 47.1, level=0)
    except ReadError as error:
        assert str(error)


@pytest.fixture(autouse=True)
def soon() -> Iterator[None]:
    """Ends a test that does not end by itself."""

    def over(*_: object) -> None:
        raise AssertionError(f"it takes more than {MOST_SECONDS} s")

    before = signal.signal(signal.SIGALRM, over)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def test_the_package_with_its_own_metadata_is_read():
    with Package(io.BytesIO(with_metadata(json.dumps(golden_metadata()).encode()))) as package:
        assert package.tile(0, 0, 0).terrain.triangles.size


@pytest.mark.parametrize("text", HOSTILE)
def test_no_number_of_a_manifest_raises_another_error(text):
    manifest = golden_metadata()["corniche"]
    places = list(numbers({key: manifest[key] for key in USED}))
    assert len(places) > 12
    for path in places:
        metadata = golden_metadata()
        inner = metadata["corniche"]
        for key in path[:-1]:
            inner = inner[key]
        inner[path[-1]] = "HERE"
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            signal.alarm(MOST_SECONDS)
            try:
                use(with_metadata(json.dumps(metadata).replace('"HERE"', text).encode()))
            except Exception as error:
                raise AssertionError(f"{path} = {text[:20]}: {type(error).__name__}: {error}") from error
            signal.alarm(0)


@pytest.mark.parametrize("name", ["corniche", "frame", "coordinates", "cell_m", "vertical", "layers", "table"])
@pytest.mark.parametrize("text", ["[" * 100_000, "[" * 100_000 + "]" * 100_000, '{"a":' * 50_000 + "1" + "}" * 50_000, "7", "null", "[]"])
def test_no_other_shape_of_a_manifest_raises_another_error(name, text):
    whole = golden_metadata()
    layers = whole["corniche"].get("layers", [])
    for inner in (whole, whole["corniche"], whole["corniche"]["frame"], *layers):
        if name in inner:
            inner[name] = "HERE"
            break
    signal.alarm(MOST_SECONDS)
    use(with_metadata(json.dumps(whole).replace('"HERE"', text).encode()))


def test_metadata_that_are_no_text_are_refused():
    for text in (b"", b"\xff\xfe\x00", b"[" * 200_000, b"\xef\xbb\xbf{}", b"nul"):
        with pytest.raises(ReadError):
            Package(io.BytesIO(with_metadata(text)))


@pytest.mark.skipif("CORNICHE_HOSTILE" not in os.environ, reason="CORNICHE_HOSTILE names no folder of hostile packages")
def test_hostile_packages_are_read_or_refused():
    """`cargo run --example write_hostile --features hostile -p corniche-testing FOLDER` writes them."""
    paths = sorted(Path(os.environ["CORNICHE_HOSTILE"]).glob("*.pmtiles"))
    assert len(paths) > 150
    for path in paths:
        begun = time.process_time()
        try:
            with Package.open(path) as package:
                for name in package.tiles():
                    for objects in package.tile(*name).layers.values():
                        for found in objects[:99]:
                            found.on_ground()
        except ReadError as error:
            assert str(error)
        except Exception as error:
            raise AssertionError(f"{path.name}: {type(error).__name__}: {error}") from error
        print(path.name, f"{time.process_time() - begun:.1f} s")
