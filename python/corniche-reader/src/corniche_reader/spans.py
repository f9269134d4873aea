"""The section of spans (kind 13 of the format): runs of bridges and tunnels off the ground."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .codes import Cursor, unzigzag
from .grid import Grid, TileName
from .height import Ground
from .layers import LayerTable
from .points import lattice_points

#: The number of classes of roads, after which the layers are numbered.
CLASSES = 9
#: Limits of section 11 of the format.
MOST_RUNS, FARTHEST_STEPS, MOST_HEIGHT = 1 << 20, 1 << 55, 1 << 31


@dataclass(frozen=True)
class Span:
    """A stretch of a bridge above the ground of its tile, or of a tunnel below it."""

    way_id: int
    #: The class of a road; None for a line of a layer.
    road_class: int | None
    #: The id of the layer; None for a road.
    layer: str | None
    #: `bridge` or `tunnel`.
    structure: str
    #: [x, y, z] of each vertex: working metres, and the height in metres, which is an estimate.
    vertices: NDArray[np.float64]
    #: Whether the first and the last vertex lie on the ground.
    on_ground: tuple[bool, bool]


def read_spans(data: bytes, ground: Ground, grid: Grid, tile: TileName, layers: Sequence[LayerTable] = ()) -> list[Span]:
    """Decodes the section of spans of a tile with the given ground, in a package with these layers."""
    owners: dict[int, tuple[int | None, str | None]] = {number: (number, None) for number in range(CLASSES)}
    owners.update({number: (None, table.id) for number, table in enumerate(layers, CLASSES) if table.has_spans})
    what = "spans of tile {}/{}/{}".format(*tile)
    cursor = Cursor(data, what)
    count = cursor.varint()
    if count > MOST_RUNS:
        raise cursor.error("too many runs")
    codes, ways, sizes = (cursor.planes(count) for _ in range(3))
    corner = grid.lattice_of_node(tile, 0, 0)
    lines = lattice_points(cursor, [size + 2 for size in sizes], corner)
    ends = [(bool(code & 1), bool(code & 2)) for code in codes]
    on_ground = sum(map(sum, ends))
    heights, triangles = cursor.planes(sum(map(len, lines)) - on_ground), cursor.planes(on_ground)
    cursor.end()
    steps, named = iter(heights), iter(triangles)
    spans: list[Span] = []
    before = (0, -1 << 63)
    way = height = 0
    for code, way_step, points, (first, last) in zip(codes, ways, lines, ends, strict=True):
        way = (way + unzigzag(way_step) + (1 << 63)) % (1 << 64) - (1 << 63)
        owner = owners.get(code >> 3)
        if owner is None or before > (code >> 3, way):
            raise cursor.error("a class or a layer with spans does not exist, or runs are not sorted")
        before = (code >> 3, way)
        vertices = np.empty((len(points), 3))
        for i, point in enumerate(points):
            if i and point == points[i - 1] or max(abs(point[0] - corner[0]), abs(point[1] - corner[1])) > FARTHEST_STEPS:
                raise cursor.error("a run repeats a point, or has one that is too far away")
            if i == 0 and first or i == len(points) - 1 and last:
                triangle = next(named)
                if triangle >= len(ground.mesh.triangles):
                    raise cursor.error(f"triangle {triangle} does not exist")
                vertices[i, 2] = ground.height_in(triangle, point)
            else:
                height += unzigzag(next(steps))
                if not -MOST_HEIGHT <= height < MOST_HEIGHT:
                    raise cursor.error("a height is beyond 32 bits")
                vertices[i, 2] = float(height) * grid.quantum_m
            vertices[i, :2] = grid.working(*point)
        spans.append(Span(way, *owner, "tunnel" if code & 4 else "bridge", vertices, (first, last)))
    return spans
