"""The section of GEO roads (sections 6 and 7 of the format): classes, heads, points, and vertices that are guessed or surprises."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .coded_lines import Line, Surprise, coded_lines
from .codes import Cursor, unzigzag
from .grid import Grid, TileName
from .height import Ground, Vertex
from .mesh import Point, orient
from .points import lattice_points

#: The kinds of vertices of a line.
SOURCE, CROSSING, TIN_VERTEX = 1, 2, 3
END = (0,)


@dataclass(frozen=True)
class Road:
    """One part of a way in a tile, draped on the TIN."""

    way_id: int
    road_class: int
    part: int
    #: [x, y, z] of each vertex: working metres, and the height in metres.
    vertices: NDArray[np.float64]
    #: The kind of each vertex: SOURCE, CROSSING or TIN_VERTEX.
    kinds: NDArray[np.int8]


def read_roads(data: bytes, is_coded: bool, ground: Ground, grid: Grid, tile: TileName) -> list[Road]:
    """Decodes the section; `is_coded` tells whether the section consists of range-coded bits."""
    what = "GEO roads of tile {}/{}/{}".format(*tile)
    whole = Cursor(data, what)
    step_m = struct.unpack("<2d", whole.take(16)) if is_coded else (0.0, 0.0)
    if is_coded and not all(0 < step < math.inf for step in step_m):
        raise whole.error("the lattice steps of the grid are beyond their limits")
    counts = [(whole.word(4), whole.word(4)) for _ in range(9)]
    follower = _Follower(ground, whole)
    roads = []
    for number, (lines, size) in enumerate(counts):
        content = whole.take(size)
        if is_coded:
            found = coded_lines(content, lines, (step_m[0], step_m[1]), grid, what)
        else:
            cursor = Cursor(content, what)
            found = [(line, _surprises(cursor)) for line in _lines(cursor, lines, grid.lattice_of_node(tile, 0, 0))]
            cursor.end()
        for line, surprises in found:
            vertices = follower.follow(line, surprises)
            places = np.empty((len(vertices), 3))
            for i, vertex in enumerate(vertices):
                u, v, z = vertex[1]
                places[i, :2] = grid.working(u, v)
                places[i, 2] = z
            kinds = np.array([kind for kind, _ in vertices], np.int8)
            roads.append(Road(line.way_id, number, line.part, places, kinds))
    whole.end()
    return roads


def _lines(cursor: Cursor, count: int, corner: Point) -> list[Line]:
    if count > len(cursor.data):
        raise cursor.error("more lines than the section has bytes")
    way, lines = 0, []
    for _ in range(count):
        way += unzigzag(cursor.varint())
        lines.append(Line(way, 0, 0, []))
    for line in lines:
        line.part = cursor.varint()
    sizes = []
    for line in lines:
        head = cursor.varint()
        line.flags = head & 3
        sizes.append(head >> 2)
    if not lines:
        return lines
    for line, points in zip(lines, lattice_points(cursor, sizes, corner), strict=True):
        line.points = points
    return lines


def _surprises(cursor: Cursor) -> list[Surprise]:
    found = []
    for _ in range(cursor.varint()):
        gap, kind = cursor.varint(), cursor.byte()
        if kind > TIN_VERTEX:
            raise cursor.error(f"a surprise of the unknown kind {kind}")
        found.append((gap, (kind, *(cursor.varint() for _ in range((0, 1, 2, 1)[kind])))))
    return found


class _Follower:
    """Follows lines over the TIN, and computes the positions of their vertices in f64 as the format specifies."""

    def __init__(self, ground: Ground, cursor: Cursor) -> None:
        self.ground, self.mesh, self.error = ground, ground.mesh, cursor.error

    def follow(self, line: Line, surprises: list[Surprise]) -> list[tuple[int, Vertex]]:
        """The kind and the position [u, v, z] of each vertex."""
        points, used = line.points, line.flags & 1
        last = len(points) - (line.flags >> 1 & 1)
        found: list[tuple[int, Vertex]] = []
        rest: Iterator[Surprise] = iter(surprises)
        gap, surprise = next(rest, (-1, END))
        here: tuple[int, ...] | None = None
        while True:
            if gap == 0:
                vertex = surprise
                gap, surprise = next(rest, (-1, END))
            else:
                vertex = self._guess(points, used, last, here)
                gap -= gap > 0
            if vertex[0] == 0:
                break
            if any(n >= self._count(vertex[0]) for n in vertex[1:]) or len(found) > 1 << 22:
                raise self.error(f"way {line.way_id} refers to a vertex, edge or triangle that the TIN does not have")
            if vertex[0] == SOURCE:
                if used >= last:
                    raise self.error(f"way {line.way_id} has more vertices than points")
                found.append((SOURCE, self.ground.source(points[used], vertex[1])))
                used += 1
            elif vertex[0] == CROSSING:
                if not 0 < used < len(points):
                    raise self.error(f"way {line.way_id} crosses an edge outside its segments")
                a, b, p, q = *vertex[1:], points[used - 1], points[used]
                if orient(p, q, self.mesh.points[a]) == orient(p, q, self.mesh.points[b]):
                    raise self.error(f"way {line.way_id} does not cross the edge that it names")
                found.append((CROSSING, self.ground.crossing(a, b, p, q)))
            else:
                found.append((TIN_VERTEX, self.ground.vertex(vertex[1])))
            here = vertex
        if used != last or gap >= 0:
            raise self.error(f"way {line.way_id} ends before its last point or surprise")
        return found

    def _count(self, kind: int) -> int:
        return len(self.mesh.triangles) if kind == SOURCE else len(self.mesh.points)

    def _guess(self, points: list[Point], used: int, last: int, here: tuple[int, ...] | None) -> tuple[int, ...]:
        if used >= len(points):
            return END
        if here is None:
            if used:
                raise self.error("a line with a lead-in does not begin with a surprise")
            triangle = self.mesh.locate(points[0])
            return END if triangle is None else (SOURCE, triangle)
        if used == 0:
            raise self.error("a line has a vertex before its first point")
        guess = self._from(points[used - 1], points[used], here)
        return END if guess[0] == SOURCE and used >= last else guess

    def _from(self, p: Point, q: Point, here: tuple[int, ...]) -> tuple[int, ...]:
        mesh = self.mesh
        if here[0] == SOURCE:
            t = here[1]
            corners = mesh.triangles[t]
            for v in corners:
                if mesh.points[v] == p:
                    return self._from_vertex(v, p, q)
            for k in range(3):
                a, b = corners[k], corners[(k + 1) % 3]
                pa, pb = mesh.points[a], mesh.points[b]
                if orient(pa, pb, p) == 0 and orient(pa, pb, q) < 0:
                    return self._ahead(mesh.on_left.get((b, a)), p, q, None)
            return self._ahead(t, p, q, None)
        if here[0] == TIN_VERTEX:
            return self._from_vertex(here[1], p, q)
        a, b = here[1], here[2]
        edge = (a, b) if orient(p, q, mesh.points[a]) > 0 else (b, a)
        return self._ahead(mesh.on_left.get(edge), p, q, None)

    def _from_vertex(self, v: int, p: Point, q: Point) -> tuple[int, ...]:
        mesh = self.mesh
        for t, k in mesh.around[v]:
            corners = mesh.triangles[t]
            pv, after, before = (mesh.points[corners[(k + i) % 3]] for i in range(3))
            if orient(pv, after, q) >= 0 and orient(before, pv, q) >= 0:
                return self._ahead(t, p, q, v)
        return END

    def _ahead(self, t: int | None, p: Point, q: Point, at: int | None) -> tuple[int, ...]:
        if t is None:
            return END
        mesh = self.mesh
        corners = mesh.triangles[t]
        places = [mesh.points[v] for v in corners]
        inside = min(orient(places[k], places[(k + 1) % 3], q) for k in range(3))
        if inside > 0:
            return (SOURCE, t)
        if inside == 0:
            located = mesh.locate(q)
            return END if located is None else (SOURCE, located)
        sides = [orient(p, q, place) for place in places]
        for k in range(3):
            if sides[k] < 0 < sides[(k + 1) % 3]:
                a, b = corners[k], corners[(k + 1) % 3]
                return (CROSSING, min(a, b), max(a, b))
        x, y = p if at is None else mesh.points[at]
        for v, side, (cx, cy) in zip(corners, sides, places, strict=True):
            if side == 0 and v != at and (q[0] - p[0]) * (cx - x) + (q[1] - p[1]) * (cy - y) > 0:
                return (TIN_VERTEX, v)
        return END
