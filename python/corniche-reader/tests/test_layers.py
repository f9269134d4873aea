"""Layers: sections that are encoded here, objects on the ground in closed form, rejected sections, and tables of a manifest."""

from __future__ import annotations

import copy
import io
import math
import random
import struct
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from encoding import package_of, payload, planes, point_columns, ring_bits, signed, varint

from corniche_reader import ContainerError, LayerObject, Package, PayloadError
from corniche_reader.grid import Grid
from corniche_reader.height import Ground
from corniche_reader.layers import LayerTable, layer_tables, read_layer
from corniche_reader.laying import cut, lay
from corniche_reader.mesh import Mesh

GOLDEN = Path(__file__).parents[3] / "crates/tileset/tests/data/version-2.pmtiles"
LAYERS = Path(__file__).parents[3] / "tests/golden/all-sections.pmtiles"
TILE = (0, 0, 0)
FRAME = {"origin_m": [0.5, 0.25], "cell_m": [10, 10], "root_corner": {"i": -512, "j": 1024}, "max_level": 0}
GRID = Grid.of({"frame": FRAME, "vertical": {"quantum_m": 0.25}})
LOW, HIGH = GRID.lattice_of_node(TILE, 0, 256), GRID.lattice_of_node(TILE, 256, 0)
ATTRIBUTES = {"ele": {"number": "m"}, "name": "names", "ref": "text", "seamark": "yes-no"}
NAMES = {"": "Füssener See", "de": "Füssener See", "en": "Lake"}
#: Three objects: class, type, id, and the values of the attributes.
OBJECTS = [
    (2, 1, -(1 << 63), (-12.0, NAMES, "Lake", True)),
    (0, 0, (1 << 63) - 1, (0.1, None, None, None)),
    (1, 2, 0, (None, {"en": "Lake"}, "", False)),
]
NUMBER, NUMBER_VALUES, NAME, LANGUAGES, NAME_TEXTS, TEXT, YES_NO, SHAPES = range(4, 12)


def at(u: int, v: int) -> tuple[int, int]:
    """A point, in steps from the tile's south-western corner."""
    return LOW[0] + u, LOW[1] + v


def table(geometry: str) -> LayerTable:
    form = {"id": "own", "geometry": geometry, "attributes": dict(reversed(ATTRIBUTES.items())), "class": [{"id": name} for name in "abc"]}
    return layer_tables({"layers": [{"table": form}]})[0]


def heads(objects: list[tuple[int, int, int, tuple[Any, ...]]]) -> list[bytes]:
    """The columns before the shapes."""
    values = [values for *_, values in objects]
    texts = sorted({text for _, names, text, _ in values for text in [*(names or {}), *(names or {}).values(), text] if text is not None})
    contents = [text.encode() for text in texts]
    numbers = [number for number, *_ in values]
    kinds = [0 if number is None else 1 if number == int(number) else 2 for number in numbers]
    codes = [signed(int(n)) if kind == 1 else struct.unpack("<Q", struct.pack("<d", n))[0] for n, kind in zip(numbers, kinds, strict=True) if kind]
    names = [pair for _, names, *_ in values for pair in (names or {}).items()]
    steps = [to - at for at, to in pairwise([0, *(number for _, _, number, _ in objects)])]
    return [
        planes(4 * number + kind for number, kind, *_ in objects),
        planes(signed((step + (1 << 63)) % (1 << 64) - (1 << 63)) for step in steps),
        varint(len(texts)),
        planes(map(len, contents)) + b"".join(contents),
        planes(kinds),
        planes(codes),
        planes(len(names or {}) for _, names, *_ in values),
        planes(texts.index(language) for language, _ in names),
        planes(texts.index(name) for _, name in names),
        planes(0 if text is None else 1 + texts.index(text) for *_, text, _ in values),
        planes(0 if yes is None else 1 + yes for *_, yes in values),
    ]


def section(columns: list[bytes], spacing: int = 64, count: int = 3) -> bytes:
    return varint(spacing) + varint(count) + b"".join(columns)


def on_lattice(u: int, v: int, spacing: int = 64) -> tuple[int, int]:
    return tuple((part // spacing + 1) * spacing for part in at(u, v))


LINES = [
    [on_lattice(0, -999), on_lattice(700, 800)],
    [on_lattice(9, 9), on_lattice(9, 900), on_lattice(9, 9)],
    [on_lattice(-(1 << 40), 5), on_lattice(1, 1)],
]
POINTS = [on_lattice(0, 0), on_lattice(1 << 20, 1 << 21), on_lattice(5000, 1)]
#: The second area shares a border with the first one, backwards, and has a ring of points off the lattice; so has the third one.
LAKE = [at(64 * n, 64 * n * n) for n in range(20)]
AREAS = [
    [[LAKE + [at(0, 64 * 400)], [at(1, 2), at(3, 4), at(5, 7)]]],
    [[LAKE[14:4:-1] + [at(64 * 300, 64)]], [[at(64, 7), at(640, 7), at(641, 64), LAKE[3], LAKE[4], LAKE[5]]]],
    [[[HIGH, (LOW[0], HIGH[1]), LOW, (HIGH[0], LOW[1])]]],
]


def line_columns() -> list[bytes]:
    return [*heads(OBJECTS), planes(len(line) - 2 for line in LINES), *point_columns([point for line in LINES for point in line], 64, LOW)]


def area_columns() -> list[bytes]:
    rings = [ring for area in AREAS for polygon in area for ring in polygon]
    counts = [len(area) - 1 for area in AREAS], [len(polygon) - 1 for area in AREAS for polygon in area], [len(ring) - 3 for ring in rings]
    return [*heads(OBJECTS), *map(planes, counts), ring_bits(rings, 64, LOW)]


def read(data: bytes, geometry: str, ground: Ground | None = None) -> list[LayerObject]:
    return read_layer(data, table(geometry), ground, GRID, TILE)


def working(points: list[tuple[int, int]]) -> list[list[float]]:
    return [list(GRID.working(*point)) for point in points]


def check_heads(objects: list[LayerObject]) -> None:
    for found, (number, kind, osm_id, values) in zip(objects, OBJECTS, strict=True):
        assert (found.class_id, found.osm_type, found.osm_id) == ("abc"[number], ("node", "way", "relation")[kind], osm_id)
        assert found.attributes == {key: value for key, value in zip(ATTRIBUTES, values, strict=True) if value is not None}


def test_lines_and_points_are_read():
    objects = read(section(line_columns()), "line")
    check_heads(objects)
    assert [found.points.tolist() for found in objects] == [working(line) for line in LINES]
    assert all(found.polygons is None and found.on_ground() == [] for found in objects)
    objects = read(section([*heads(OBJECTS), *point_columns(POINTS, 64, LOW)]), "point")
    check_heads(objects)
    assert [found.points.tolist() for found in objects] == [working([point]) for point in POINTS]
    assert read(section([*heads([]), planes([]), planes([])], count=0), "point") == []


def test_areas_are_read():
    objects = read(section(area_columns()), "area")
    check_heads(objects)
    for found, area in zip(objects, AREAS, strict=True):
        assert [[ring.tolist() for ring in polygon] for polygon in found.polygons] == [[working(ring) for ring in polygon] for polygon in area]
        assert found.points is None and found.on_ground() == []


def test_rings_that_share_points_in_every_way_are_read():
    noise = random.Random(7)
    for _ in range(60):
        spacing = noise.choice([1, 64, 1000])
        rings = [[at(1000 * noise.randrange(4), 997 * noise.randrange(4)) for _ in range(noise.randrange(3, 12))] for _ in range(6)]
        objects = [(0, 1, number, (None, None, None, None)) for number in range(6)]
        columns = [*heads(objects), planes([0] * 6), planes([0] * 6), planes(len(ring) - 3 for ring in rings), ring_bits(rings, spacing, LOW)]
        found = read(section(columns, spacing, 6), "area")
        assert [area.polygons[0][0].tolist() for area in found] == [working(ring) for ring in rings]


def changed(columns: list[bytes], place: int, column: bytes) -> bytes:
    return section([*columns[:place], column, *columns[place + 1 :]])


HUGE, FAR = planes([1 << 56, 0, 0]), planes([(1 << 64) - 2, 0, 0])
REFUSED = [
    ("point", 0, planes([3 << 2, 0, 0]), "a class or a type"),
    ("point", 0, planes([3, 0, 0]), "a class or a type"),
    ("point", 2, varint((1 << 20) + 1), "too many texts"),
    ("point", 3, planes([99] * 4), "ends too early"),
    ("point", 3, planes([0, 2, 1, 1]) + b"a\xffbc", "utf-8"),
    ("point", NUMBER, planes([1, 3, 0]), "an invalid number"),
    ("point", NUMBER_VALUES, planes([0, 0x7FF0 << 48]), "an invalid number"),
    ("point", NUMBER_VALUES, planes([0, 0x7FF8 << 48]), "an invalid number"),
    ("point", NAME, HUGE, "too many names"),
    ("point", NAME, planes([257, 0, 0]), "too many names"),
    ("point", LANGUAGES, planes([0, 2, 1, 3]), "not sorted"),
    ("point", LANGUAGES, planes([0, 0, 1, 3]), "not sorted"),
    ("point", NAME_TEXTS, planes([9, 0, 0, 0]), "text 9 does not exist"),
    ("point", TEXT, planes([(1 << 64) - 1, 0, 0]), "does not exist"),
    ("point", YES_NO, planes([3, 0, 0]), "neither yes nor no"),
    ("point", SHAPES, planes([1, 0, 0]), "outside the tile"),
    ("point", SHAPES, FAR, "too far away"),
    ("line", SHAPES, HUGE, "too many points"),
    ("line", SHAPES + 1, planes([0] * 7), "two equal points|too far"),
    ("line", SHAPES + 1, bytes([9]), "planes of 9 bytes"),
    ("area", SHAPES, HUGE, "too many polygons"),
    ("area", SHAPES + 1, planes([1 << 56, 0, 0, 0]), "too many polygons"),
    ("area", SHAPES + 2, planes([1 << 56, 0, 0, 0, 0]), "too many polygons"),
    ("area", SHAPES + 3, bytes([255] * 90), "does not exist|too early|too many|outside"),
    ("area", SHAPES + 3, b"", "too early"),
]


@pytest.mark.parametrize(("geometry", "place", "column", "says"), REFUSED)
def test_what_no_writer_writes_is_refused(geometry, place, column, says):
    columns = {"line": line_columns, "area": area_columns}.get(geometry, lambda: [*heads(OBJECTS), *point_columns(POINTS, 64, LOW)])()
    if "two equal points" in says:
        columns[SHAPES + 2] = column
    with pytest.raises(PayloadError, match=says):
        read(changed(columns, place, column), geometry)


@pytest.mark.parametrize(("geometry", "columns"), [("line", line_columns), ("area", area_columns)])
def test_counts_cuts_and_bytes_too_many_are_refused(geometry, columns):
    whole = section(columns())
    cuts = [whole[:length] for length in range(0, len(whole), 5)]
    for data in (*cuts, whole[:-1], whole + b"\0", section(columns(), 0), section(columns(), (1 << 40) + 1), section(columns(), 64, 1 << 19)):
        with pytest.raises(PayloadError):
            read(data, geometry)


# The ground: squares of 64 × 64 cells with one diagonal, on the plane z = 100 + east / 8 + north / 4 in cells. A square is a hole.
CELL = GRID.steps[0]
NODES = [(LOW[0] + 64 * CELL * column, LOW[1] + 64 * CELL * row) for row in range(5) for column in range(5)]


def ground(hole: tuple[int, int] | None) -> Ground:
    triangles = []
    for row in range(4):
        for column in range(4):
            a = 5 * row + column
            if (column, row) != hole:
                triangles += [[a, a + 1, a + 6], [a, a + 6, a + 5]]
    return Ground(Mesh(NODES, triangles), [plane(*node) for node in NODES])


def plane(u: float, v: float) -> float:
    return 100 + (u - LOW[0]) / CELL / 8 + (v - LOW[1]) / CELL / 4


def cells(*places: tuple[float, float]) -> list[tuple[int, int]]:
    return [(LOW[0] + int(column * CELL), LOW[1] + int(row * CELL)) for column, row in places]


def laid(points: list[tuple[int, int]], hole: tuple[int, int] | None = None) -> list[list[tuple[float, float]]]:
    """The vertices of a line on the ground, in cells; heights are checked."""
    lines = [line for part in cut(points, LOW, HIGH) for line in lay(part, ground(hole), "a line")]
    for line in lines:
        assert all(abs(z - plane(u, v)) < 1e-9 for u, v, z in line)
    return [[((u - LOW[0]) / CELL, (v - LOW[1]) / CELL) for u, v, _ in line] for line in lines]


def test_lines_have_a_vertex_at_each_point_edge_and_tin_vertex():
    # Across two diagonals and the edge between their squares.
    assert laid(cells((16, 32), (112, 32))) == [[(16, 32), (32, 32), (64, 32), (96, 32), (112, 32)]]
    # Along a diagonal, through a vertex, and along an edge.
    assert laid(cells((32, 32), (96, 96))) == [[(32, 32), (64, 64), (96, 96)]]
    assert laid(cells((64, 16), (64, 80))) == [[(64, 16), (64, 64), (64, 80)]]
    # A point on an edge, on a vertex, and a line that turns back.
    assert laid(cells((48, 32), (64, 32), (64, 64), (64, 32))) == [[(48, 32), (64, 32), (64, 64), (64, 32)]]


def test_stretches_without_ground_are_omitted():
    hole = (1, 0)
    assert laid(cells((48, 32), (144, 32)), hole) == [[(48, 32), (64, 32)], [(128, 32), (144, 32)]]
    # The boundary of the ground belongs to the ground.
    assert laid(cells((64, 0), (64, 64), (128, 64)), hole) == [[(64, 0), (64, 64), (128, 64)]]
    # A line that begins in the hole, and one that only touches the ground at a point.
    assert laid(cells((96, 32), (160, 32)), hole) == [[(128, 32), (160, 32)]]
    assert laid(cells((96, 32), (128, 64), (96, 16)), hole) == []
    assert laid(cells((96, 16), (100, 20)), hole) == []


def test_lines_are_cut_at_the_border_of_the_tile():
    assert laid(cells((-64, 32), (48, 32))) == [[(0, 32), (32, 32), (48, 32)]]
    assert laid(cells((-64, -64), (-1, 300))) == []
    assert laid(cells((-64, 0), (300, 0))) == [[(64 * column, 0) for column in range(5)]]
    assert laid(cells((16, 32), (-16, 32), (-16, 48), (16, 48))) == [[(16, 32), (0, 32)], [(0, 48), (16, 48)]]
    # A cut has the border's coordinate; the other one is rounded, a half upwards, from both ends.
    for sign in (1, -1):
        points = [(LOW[0] - 1, LOW[1] + 7), (LOW[0] + 1, LOW[1] + 8)][::sign]
        assert cut(points, LOW, HIGH) == [[(LOW[0], LOW[1] + 8), (LOW[0] + 1, LOW[1] + 8)][::sign]]
    assert cut([(LOW[0] - 1, LOW[1]), LOW], LOW, HIGH) == []


def test_random_lines_cover_exactly_their_stretches_on_the_ground():
    """The middles of pieces have ground; the middles between pieces have none; each piece is in one triangle."""
    noise = random.Random(3)
    surface = ground((1, 2))
    for _ in range(300):
        ends = [tuple(noise.choice([noise.randrange(0, 257), 64 * noise.randrange(0, 5)]) for _ in range(2)) for _ in range(2)]
        if ends[0] == ends[1]:
            continue
        p, q = cells(*ends)

        def place(share: Fraction, p=p, q=q) -> tuple[Fraction, Fraction]:
            return tuple(a + share * (b - a) for a, b in zip(p, q, strict=True))

        axis = 0 if p[0] != q[0] else 1
        lines = [[Fraction(vertex[axis] - p[axis]) / (q[axis] - p[axis]) for vertex in line] for line in lay([p, q], surface, "")]
        assert all(len(line) > 1 and line == sorted(set(line)) for line in lines)
        for line in lines:
            for one, other in pairwise(line):
                assert surface.mesh.locate(place((one + other) / 2)) is not None
        bounds = [Fraction(0), *(share for line in lines for share in (line[0], line[-1])), Fraction(1)]
        for one, other in zip(bounds[::2], bounds[1::2], strict=True):
            # Rounding moves a crossing by less than this.
            if other - one > Fraction(1, 10**9):
                assert surface.mesh.locate(place((one + other) / 2)) is None


def test_points_have_the_height_of_the_ground():
    inside, in_hole = cells((16, 33), (96, 32))
    objects = [(0, 0, number, (None, None, None, None)) for number in range(2)]
    data = section([*heads(objects), *point_columns([inside, in_hole], 1, LOW)], 1, 2)
    found, missing = read(data, "point", ground((1, 0)))
    assert [line.tolist() for line in found.on_ground()] == [[[*GRID.working(*inside), plane(*inside)]]]
    assert missing.on_ground() == []


FORM = {"id": "own", "geometry": "line", "attributes": ATTRIBUTES, "class": [{"id": "one", "tags": {"natural": True}}]}


@pytest.mark.parametrize(
    "form",
    [
        None, [], {}, {**FORM, "id": 7}, {**FORM, "geometry": "volume"}, {**FORM, "geometry": ["line"]}, {**FORM, "class": []},
        {**FORM, "class": [{}]}, {**FORM, "class": [{"id": "a"}] * 257}, {**FORM, "class": 7}, {**FORM, "attributes": []},
        {**FORM, "attributes": {"a": "colour"}}, {**FORM, "attributes": {"a": ["text"]}}, {**FORM, "attributes": {str(n): "text" for n in range(65)}},
    ],
)  # fmt: skip
def test_tables_that_no_writer_writes_are_refused(form):
    with pytest.raises(ContainerError):
        layer_tables({"layers": [{"table": form}]})


def test_lists_of_layers_that_no_writer_writes_are_refused():
    of = [{"table": {**FORM, "id": f"own-{number}"}} for number in range(65)]
    assert [table.id for table in layer_tables({"layers": of[:64]})] == [f"own-{number}" for number in range(64)]
    assert layer_tables({}) == []
    for layers in (of, [of[0], of[0]], 7, {"a": 7}, [None]):
        with pytest.raises(ContainerError):
            layer_tables({"layers": layers})


def test_layers_of_a_package_are_read_and_lie_on_its_ground():
    with Package.open(GOLDEN) as package:
        tile = package.tile(*TILE)
        metadata = copy.deepcopy(package.metadata)
        low, high = package.grid.lattice_of_node(TILE, 0, 256), package.grid.lattice_of_node(TILE, 256, 0)
        points = [tuple(a + (b - a) * share // 8 for a, b in zip(low, high, strict=True)) for share in (-1, 3, 4, 7)]
        forms = [{**FORM, "id": f"own-{geometry}", "geometry": geometry, "attributes": {}} for geometry in ("line", "area", "point")]
        package.metadata["corniche"]["layers"] = [{"table": form} for form in forms]
        head = [planes([1]), planes([2000]), varint(0), planes([])]
        own = {
            64: section([*head, planes([2]), *point_columns(points, 1, low)], 1, 1),
            66: section([*head, *point_columns(points[1:2], 1, low)], 1, 1),
        }
        kept = {kind: content for kind, content in tile.sections.items() if kind < 64 and kind != 13}
        data = package_of(package, TILE, payload(TILE, {**kept, **own}))
        package.metadata = metadata
    with Package(io.BytesIO(data)) as package:
        layers = package.tile(*TILE).layers
        assert list(layers) == ["own-line", "own-area", "own-point"] and not layers["own-area"]
        (line,), (point,) = layers["own-line"], layers["own-point"]
        assert (line.class_id, line.osm_type, line.osm_id, line.attributes) == ("one", "way", 1000, {})
        for vertices in (*line.on_ground(), *point.on_ground()):
            for (lon, lat), z in list(zip(package.degrees(vertices), vertices[:, 2], strict=True))[::5]:
                assert abs(package.height_at(lon, lat, 0) - z) < 0.01
        length = sum(math.hypot(*step) for vertices in line.on_ground() for step in np.diff(vertices[:, :2], axis=0))
        whole = [package.grid.working(*at) for at in cut(points, low, high)[0]]
        assert 0 < length <= sum(map(math.dist, whole, whole[1:])) + 1e-3
        assert np.array_equal(point.points, line.points[1:2])


def test_the_layers_of_the_golden_package_lie_on_its_ground():
    with Package.open(LAYERS) as package:
        assert {"areas", "boundaries", "railways"} <= {layer["table"]["id"] for layer in package.manifest["layers"]}
        tiles = [package.tile(*name) for name in package.tiles() if name[0] == package.grid.max_level]
        for layer in package.manifest["layers"]:
            objects = [of for tile in tiles for of in tile.layers[layer["table"]["id"]]]
            assert objects and all(of.class_id in {known["id"] for known in layer["table"]["class"]} for of in objects)
            for of in objects:
                for vertices in of.on_ground():
                    for (lon, lat), z in list(zip(package.degrees(vertices), vertices[:, 2], strict=True))[::7]:
                        assert abs(package.height_at(lon, lat) - z) < 0.01, of
