"""Layers: their tables in the manifest, and the sections with their objects (kinds 64 to 127 of the format)."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .codes import Bits, Cursor, unzigzag
from .errors import ContainerError
from .grid import Grid, TileName
from .height import Ground
from .laying import cut, lay
from .mesh import Point
from .points import MOST_POINTS, lattice_points
from .rings import Rings

#: The kind of the sections of the first layer.
FIRST_KIND = 64
#: Limits of section 11 of the format.
MOST_LAYERS, MOST_CLASSES, MOST_ATTRIBUTES, MOST_NAMES_OF_OBJECT = 64, 256, 64, 256
MOST_OBJECTS, MOST_VALUES, MOST_TEXTS, MOST_NAMES, MOST_RINGS = 1 << 18, 1 << 21, 1 << 20, 1 << 20, 1 << 19
MOST_SPACING, FARTHEST = 1 << 40, 1 << 56
TYPES = ("node", "way", "relation")

#: The value of an attribute: a text, yes or no, a number, or names by language ("" for the name without one).
Value = str | bool | float | dict[str, str]
Array = NDArray[np.float64]


@dataclass(frozen=True)
class LayerTable:
    """What a reader needs of a layer's table."""

    id: str
    #: `line`, `area` or `point`.
    geometry: str
    #: The ids of the classes.
    classes: list[str]
    #: The kept tags, ascending, and what is kept of each: `text`, `names`, `yes-no` or `number`.
    attributes: dict[str, str]
    #: Whether its lines may be on bridges and in tunnels, so that `Tile.spans` has their runs.
    has_spans: bool = False


@dataclass(frozen=True)
class LayerObject:
    """An object of a layer, or the part of it that is in a tile."""

    class_id: str
    #: `node`, `way` or `relation`.
    osm_type: str
    osm_id: int
    #: The values that the object has, by key.
    attributes: dict[str, Value]
    #: [x, y] of each point of a line, or of the point, in working metres. Lines may begin and end outside the tile. None for an area.
    points: Array | None
    #: The polygons of an area: [x, y] of each point of each ring, the outer ring first. None for a line or a point.
    polygons: list[list[Array]] | None
    _on_ground: Callable[[], list[Array]] = field(repr=False, compare=False)

    def on_ground(self) -> list[Array]:
        """A line or a point on the ground of its tile: [x, y, z] of each vertex of each stretch with ground, in working metres. Empty for an area."""
        return self._on_ground()


def layer_tables(manifest: dict[str, Any]) -> list[LayerTable]:
    """The tables of a package's layers, from the lowest to the highest."""
    try:
        tables = [_table(layer["table"]) for layer in manifest.get("layers", [])]
    except (KeyError, TypeError, AttributeError) as cause:
        raise ContainerError(f"the manifest's layers are incomplete: {cause}") from cause
    if len(tables) > MOST_LAYERS or len({table.id for table in tables}) < len(tables):
        raise ContainerError("the manifest has too many layers, or two of one name")
    return tables


def _table(form: dict[str, Any]) -> LayerTable:
    kinds = {key: "number" if isinstance(kind, dict) else kind for key, kind in form.get("attributes", {}).items()}
    attributes = dict(sorted(kinds.items(), key=lambda item: item[0].encode("utf-8", "surrogatepass")))
    has_spans = form.get("placement") == "spans"
    table = LayerTable(form["id"], form["geometry"], [of["id"] for of in form["class"]], attributes, has_spans)
    if not (
        all(isinstance(text, str) for text in (table.id, *table.classes))
        and table.geometry in ("line", "area", "point")
        and 0 < len(table.classes) <= MOST_CLASSES
        and len(attributes) <= MOST_ATTRIBUTES
        and all(kind in _COLUMNS for kind in attributes.values())
    ):
        raise ContainerError(f"the table of layer {table.id!r} is invalid")
    return table


def read_layer(data: bytes, table: LayerTable, ground: Ground | None, grid: Grid, tile: TileName) -> list[LayerObject]:
    """Decodes the section of a layer of a tile with the given ground."""
    what = "layer {} of tile {}/{}/{}".format(table.id, *tile)
    cursor = Cursor(data, what)
    spacing, count = cursor.varint(), cursor.varint()
    if not 1 <= spacing <= MOST_SPACING or count > MOST_OBJECTS or count * len(table.attributes) > MOST_VALUES:
        raise cursor.error("too many objects, or an invalid lattice")
    kinds, ids = cursor.planes(count), cursor.planes(count)
    texts = _texts(cursor)
    columns = [_COLUMNS[kind](cursor, count, texts) for kind in table.attributes.values()]
    corners = grid.lattice_of_node(tile, 0, 256), grid.lattice_of_node(tile, 256, 0)
    is_area = table.geometry == "area"
    shapes: list[Any] = _areas(cursor, count, spacing, corners) if is_area else _lines(cursor, count, spacing, corners, table.geometry)
    found: list[LayerObject] = []
    number = 0
    for kind, step, shape, *values in zip(kinds, ids, shapes, *columns, strict=True):
        number = (number + unzigzag(step) + (1 << 63)) % (1 << 64) - (1 << 63)
        if kind >> 2 >= len(table.classes) or kind & 3 > 2:
            raise cursor.error("a class or a type of object that does not exist")
        attributes = {key: value for key, value in zip(table.attributes, values, strict=True) if value is not None}
        points = None if is_area else _working(shape, grid)
        polygons = [[_working(ring, grid) for ring in polygon] for polygon in shape] if is_area else None
        place = _Place(shape, table.geometry, ground, grid, corners, what)
        found.append(LayerObject(table.classes[kind >> 2], TYPES[kind & 3], number, attributes, points, polygons, place.on_ground))
    return found


@dataclass(frozen=True)
class _Place:
    """The points of an object on the lattice, and the ground beneath them."""

    shape: Any
    geometry: str
    ground: Ground | None
    grid: Grid
    corners: tuple[Point, Point]
    what: str

    def on_ground(self) -> list[Array]:
        ground = self.ground
        if ground is None or self.geometry == "area":
            return []
        if self.geometry == "point":
            triangle = ground.mesh.locate(self.shape[0])
            lines = [] if triangle is None else [[ground.source(self.shape[0], triangle)]]
        else:
            lines = [line for part in cut(self.shape, *self.corners) for line in lay(part, ground, self.what)]
        return [np.array([(*self.grid.working(u, v), z) for u, v, z in line]) for line in lines]


def _working(points: list[Point], grid: Grid) -> Array:
    return np.array([grid.working(float(u), float(v)) for u, v in points]).reshape(-1, 2)


def _texts(cursor: Cursor) -> list[str]:
    count = cursor.varint()
    if count > MOST_TEXTS:
        raise cursor.error("too many texts")
    try:
        return [cursor.take(length).decode() for length in cursor.planes(count)]
    except ValueError as cause:
        raise cursor.error(str(cause)) from cause


def _text(texts: list[str], number: int, cursor: Cursor) -> str:
    if number >= len(texts):
        raise cursor.error(f"text {number} does not exist")
    return texts[number]


def _text_column(cursor: Cursor, count: int, texts: list[str]) -> list[Value | None]:
    return [_text(texts, head - 1, cursor) if head else None for head in cursor.planes(count)]


def _yes_no_column(cursor: Cursor, count: int, _: list[str]) -> list[Value | None]:
    heads = cursor.planes(count)
    if max(heads, default=0) > 2:
        raise cursor.error("neither yes nor no")
    return [(None, False, True)[head] for head in heads]


def _number_column(cursor: Cursor, count: int, _: list[str]) -> list[Value | None]:
    heads = cursor.planes(count)
    codes = iter(cursor.planes(sum(map(bool, heads))))
    found: list[Value | None] = []
    for head in heads:
        number = None
        if head:
            code = next(codes)
            number = float(unzigzag(code)) if head == 1 else struct.unpack("<d", code.to_bytes(8, "little"))[0]
            if head > 2 or not math.isfinite(number):
                raise cursor.error("an invalid number")
        found.append(number)
    return found


def _names_column(cursor: Cursor, count: int, texts: list[str]) -> list[Value | None]:
    heads = cursor.planes(count)
    total = sum(heads)
    if total > MOST_NAMES or max(heads, default=0) > MOST_NAMES_OF_OBJECT:
        raise cursor.error("too many names")
    pairs: Iterator[tuple[int, int]] = iter(zip(cursor.planes(total), cursor.planes(total), strict=True))
    found: list[Value | None] = []
    for head in heads:
        numbers = [next(pairs) for _ in range(head)]
        names = [(_text(texts, language, cursor), _text(texts, name, cursor)) for language, name in numbers]
        languages = [language.encode() for language, _ in names]
        if any(one >= other for one, other in pairwise(languages)):
            raise cursor.error("languages are not sorted")
        found.append(dict(names) if names else None)
    return found


_COLUMNS = {"text": _text_column, "yes-no": _yes_no_column, "number": _number_column, "names": _names_column}


def _lines(cursor: Cursor, count: int, spacing: int, corners: tuple[Point, Point], geometry: str) -> list[list[Point]]:
    """The points of each line; a point is a line of one."""
    sizes = [size + 2 for size in cursor.planes(count)] if geometry == "line" else [1] * count
    (low_u, low_v), (high_u, high_v) = corners
    coarse = lattice_points(cursor, sizes, (low_u // spacing, low_v // spacing))
    cursor.end()
    lines = [[(u * spacing, v * spacing) for u, v in line] for line in coarse]
    for line in lines:
        if any(max(abs(u), abs(v)) > FARTHEST for u, v in line) or any(one == other for one, other in pairwise(line)):
            raise cursor.error("a point too far away, or a line with two equal points in succession")
    if geometry == "point" and any(not (low_u <= u <= high_u and low_v <= v <= high_v) for ((u, v),) in lines):
        raise cursor.error("a point outside the tile")
    return lines


def _areas(cursor: Cursor, count: int, spacing: int, corners: tuple[Point, Point]) -> list[list[list[list[Point]]]]:
    """The points of each ring of each polygon of each area."""
    counts = [number + 1 for number in cursor.planes(count)]
    _limit(cursor, counts, MOST_RINGS)
    rings = [number + 1 for number in cursor.planes(sum(counts))]
    _limit(cursor, rings, MOST_RINGS)
    sizes = [number + 3 for number in cursor.planes(sum(rings))]
    _limit(cursor, sizes, MOST_POINTS)
    bits = Bits(cursor.take(len(cursor.data) - cursor.at), cursor.what)
    decoder = Rings(bits, spacing, corners)
    of_rings, of_polygons = iter(sizes), iter(rings)
    areas = [[[decoder.read(next(of_rings)) for _ in range(next(of_polygons))] for _ in range(polygons)] for polygons in counts]
    bits.end()
    return areas


def _limit(cursor: Cursor, counts: list[int], most: int) -> None:
    if sum(counts) > most:
        raise cursor.error("too many polygons, rings or points")
