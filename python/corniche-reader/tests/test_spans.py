"""Spans: the example of the format, rejected sections, and a whole package against `corniche tile --json`, bit for bit."""

from __future__ import annotations

import functools
import io
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from encoding import package_of, payload, planes, signed, varint

from corniche_reader import Package, PayloadError, Span
from corniche_reader.grid import Grid
from corniche_reader.height import Ground
from corniche_reader.layers import LayerTable
from corniche_reader.spans import read_spans

REPOSITORY = Path(__file__).parents[3]
GOLDEN = [REPOSITORY / "crates/tileset/tests/data" / name for name in ("version-2.pmtiles", "version-2-degrees.pmtiles")]
PROGRAM = os.environ.get("CORNICHE")
# : Columns of a section with two runs of two points: from the ground in triangle 0 to the air, and
# back.
SOUND = [[24 + 1, 24 + 4 + 2], [2000, 0], [0, 0], [2, 2, 0, 8], [0, 2, 0, 0], [800, 1], [0, 0]]


def section(columns: list[list[int]], runs: int | None = None) -> bytes:
    return varint(len(columns[0]) if runs is None else runs) + b"".join(map(planes, columns))


@functools.cache
def golden() -> tuple[Ground, Grid]:
    with Package.open(GOLDEN[0]) as package:
        return Ground.of(package.tile(0, 0, 0).terrain, package.grid, (0, 0, 0)), package.grid


def read(data: bytes) -> tuple[list[Span], Grid]:
    ground, grid = golden()
    return read_spans(data, ground, grid, (0, 0, 0)), grid


def test_the_example_of_the_format_is_read():
    text = (REPOSITORY / "crates/tileset/FORMAT.md").read_text(encoding="utf-8")
    dump = next(line for line in text.splitlines() if line.startswith("01 │ 01 19 │"))
    (span,), grid = read(bytes.fromhex(dump.replace("│", "")))
    assert (span.way_id, span.road_class, span.structure, span.on_ground) == (1000, 3, "bridge", (True, False))
    assert span.vertices[1:, 2].tolist() == [400 * grid.quantum_m, 380 * grid.quantum_m]
    u, v = grid.lattice_of_node((0, 0, 0), 0, 0)
    assert span.vertices[2, :2].tolist() == list(grid.working(u + 96, v - 130))


def test_sound_columns_are_read():
    (one, other), grid = read(section(SOUND))
    assert [(span.way_id, span.structure, span.on_ground) for span in (one, other)] == [
        (1000, "bridge", (True, False)),
        (1000, "tunnel", (False, True)),
    ]
    assert (one.vertices[1, 2], other.vertices[0, 2]) == (400 * grid.quantum_m, 399 * grid.quantum_m)
    assert not read(section([[]] * 7))[0]


def test_runs_of_layers_are_named():
    walls, railways = (LayerTable(name, "line", ["one"], {}, name == "railways") for name in ("walls", "railways"))
    ground, grid = golden()
    columns = [[24 + 1, 8 * 10 + 4 + 2], *SOUND[1:]]
    one, other = read_spans(section(columns), ground, grid, (0, 0, 0), [walls, railways])
    assert [(span.road_class, span.layer, span.structure) for span in (one, other)] == [(3, None, "bridge"), (None, "railways", "tunnel")]
    for layers in ([], [railways], [railways, walls]):
        with pytest.raises(PayloadError, match="with spans does not exist"):
            read_spans(section(columns), ground, grid, (0, 0, 0), layers)


@pytest.mark.parametrize(
    ("at", "numbers", "says"),
    [
        (0, [72 + 1, 72 + 2], "with spans does not exist"),
        (0, [24 + 1, 16 + 2], "not sorted"),
        (1, [2000, 1], "not sorted"),
        (2, [(1 << 64) - 1, 0], "too many points"),
        (3, [2, 0, 0, 8], "repeats a point"),
        (3, [(1 << 57), 2, 0, 8], "far away"),
        (5, [1 << 33, 1], "beyond 32 bits"),
        (6, [0, 1 << 40], "does not exist"),
    ],
)  # fmt: skip
def test_what_no_writer_writes_is_refused(at, numbers, says):
    columns = [numbers if at == number else column for number, column in enumerate(SOUND)]
    if at == 3 and says == "repeats a point":
        columns[4] = [0, 0, 0, 0]
    with pytest.raises(PayloadError, match=says):
        read(section(columns))


def test_counts_cuts_and_bytes_too_many_are_refused():
    sound = section(SOUND)
    for data in (sound[:-1], sound + b"\0", section(SOUND, 1 << 21), section(SOUND, 1 << 63), b"", sound[:7]):
        with pytest.raises(PayloadError):
            read(data)


def spans_over(package: Package, tile: tuple[int, int, int]) -> bytes:
    """Runs over the tile's whole ground; every other run has its ends on the ground."""
    ground, grid = package.tile(*tile).terrain, package.grid
    triangles = ground.triangles.tolist()
    corner = grid.lattice_of_node(tile, 0, 0)
    nodes = [grid.lattice_of_node(tile, int(c), int(r)) for c, r in ground.vertices.tolist()]
    columns: list[list[int]] = [[] for _ in range(7)]

    (u, v), height, way = corner, 0, 0
    for k in range(0, len(triangles) - 7, 7):
        ends = 3 * (k % 2)
        road_class, next_way = (2, 5 * k - (1 << 62)) if k < 700 else (5, 10**9 + 7 * k)
        columns[0].append(8 * road_class + 4 * (k // 7 % 2) + ends)
        columns[1].append(signed(next_way - way))
        columns[2].append(1)
        way = next_way
        # The middle of a triangle, a point between, and the middle of another triangle.
        middles = [tuple(sum(nodes[corner][axis] for corner in triangles[t]) // 3 for axis in (0, 1)) for t in (k, k + 7)]
        between = (middles[0][0] + 12_345, middles[1][1] - 54_321)
        for point, triangle in zip((middles[0], between, middles[1]), (k, None, k + 7), strict=True):
            columns[3].append(signed(point[0] - u))
            columns[4].append(signed(point[1] - v))
            u, v = point
            if ends and triangle is not None:
                columns[6].append(triangle)
            else:
                columns[5].append(signed(9_000 - 3 * k - height))
                height = 9_000 - 3 * k
    return section(columns)


@pytest.mark.skipif(not PROGRAM, reason="the environment variable CORNICHE does not name the program")
@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_spans_are_those_that_corniche_reads(path, tmp_path):
    with Package.open(path) as package:
        tile = max(package.tiles())
        content = payload(tile, {**package.tile(*tile).sections, 13: spans_over(package, tile)})
        data = package_of(package, tile, content)
    whole = tmp_path / "spans.pmtiles"
    whole.write_bytes(data)
    name = "{}/{}/{}".format(*tile)
    told = json.loads(subprocess.check_output([str(PROGRAM), "tile", str(whole), name, "--json"]))
    with Package(io.BytesIO(data)) as package:
        spans = package.tile(*tile).spans
    assert len(spans) > 20 and {span.on_ground for span in spans} == {(True, True), (False, False)}
    for span, other in zip(spans, told["spans"], strict=True):
        assert (span.way_id, span.road_class, span.structure) == (other["way_id"], other["frc"], other["structure"])
        assert list(span.on_ground) == other["on_ground"]
        assert np.array_equal(span.vertices, np.array(other["line"])), span.way_id
