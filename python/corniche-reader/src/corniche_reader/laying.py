"""Lays lines in plan on the ground of a tile (layer sections of the format, *On the ground*). All decisions are exact."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise

from .errors import PayloadError
from .height import Ground, Vertex
from .mesh import Point, orient

#: A limit of section 11 of the format: a triangle is a step, a vertex as many as this.
MOST_STEPS, STEPS_OF_VERTEX = 1 << 26, 32


def cut(points: list[Point], low: Point, high: Point) -> list[list[Point]]:
    """The parts of a line in the rectangle between two corners."""
    parts: list[list[Point]] = []
    goes_on = False
    for segment in pairwise(points):
        ends = _inside(segment, low, high)
        if ends is None:
            goes_on = False
            continue
        if not (goes_on and ends[0][0] == 0):
            parts.append([ends[0][1]])
        if ends[1][1] != parts[-1][-1]:
            parts[-1].append(ends[1][1])
        goes_on = ends[1][0] == 1
    return [part for part in parts if len(part) > 1]


def _inside(segment: tuple[Point, Point], low: Point, high: Point) -> tuple[tuple[Fraction, Point], tuple[Fraction, Point]] | None:
    """Where a segment enters the rectangle and leaves it: the share of the segment, and the point."""
    p, q = segment
    start, end = (Fraction(0), p), (Fraction(1), q)
    for axis in (0, 1):
        if p[axis] == q[axis]:
            if not low[axis] <= p[axis] <= high[axis]:
                return None
            continue
        borders = (low[axis], high[axis]) if p[axis] < q[axis] else (high[axis], low[axis])
        enters, leaves = (_cut_at(p, q, axis, border) for border in borders)
        start = enters if enters[0] > start[0] else start
        end = leaves if leaves[0] < end[0] else end
    return (start, end) if start[0] < end[0] else None


def _cut_at(p: Point, q: Point, axis: int, border: int) -> tuple[Fraction, Point]:
    share = Fraction(border - p[axis], q[axis] - p[axis])
    other = p[1 - axis] + math.floor(share * (q[1 - axis] - p[1 - axis]) + Fraction(1, 2))
    return share, (other, border) if axis else (border, other)


def lay(points: list[Point], ground: Ground, what: str) -> list[list[Vertex]]:
    """The stretches of a line on the ground, with a vertex at each point, at each edge that the line crosses and at each TIN vertex on it."""
    lines: list[list[Vertex]] = []
    steps, is_on = 0, False
    for p, q in pairwise(points):
        near = ground.mesh.near(p, q)
        stretches = dict(filter(None, (_stretch(ground, triangle, p, q) for triangle in near)))
        steps += len(near) + STEPS_OF_VERTEX * len(stretches)
        if steps > MOST_STEPS:
            raise PayloadError(f"{what}: laying a line on the ground takes too many steps")
        reached = Fraction(0) if is_on else None
        for begin, (end, first, last) in sorted(stretches.items()):
            if begin != reached:
                lines.append([first])
            lines[-1].append(last)
            reached = end
        is_on = reached == 1
    return lines


def _stretch(ground: Ground, triangle: int, p: Point, q: Point) -> tuple[Fraction, tuple[Fraction, Vertex, Vertex]] | None:
    """The stretch of a segment in a triangle: the shares of the segment and the vertices at both ends. Along an edge, both triangles have it."""
    corners = ground.mesh.triangles[triangle]
    places = [ground.mesh.points[v] for v in corners]
    # At the ends of the segment there is no edge.
    begin: tuple[Fraction, int] = (Fraction(0), -1)
    end: tuple[Fraction, int] = (Fraction(1), -1)
    for k in range(3):
        at_p, at_q = (orient(places[k], places[(k + 1) % 3], point) for point in (p, q))
        if at_p <= 0 and at_q <= 0 and (at_p or at_q):
            return None
        if at_p < 0:
            begin = max(begin, (Fraction(at_p, at_p - at_q), k))
        elif at_q < 0:
            end = min(end, (Fraction(at_p, at_p - at_q), k))
    if begin[0] >= end[0]:
        return None

    def vertex(share: Fraction, edge: int) -> Vertex:
        if edge < 0:
            point = q if share else p
            located = ground.mesh.locate(point)
            return ground.source(point, triangle if located is None else located)
        a, b = corners[edge], corners[(edge + 1) % 3]
        for v in (a, b):
            if orient(p, q, ground.mesh.points[v]) == 0:
                return ground.vertex(v)
        return ground.crossing(min(a, b), max(a, b), p, q)

    return begin[0], (end[0], vertex(*begin), vertex(*end))
