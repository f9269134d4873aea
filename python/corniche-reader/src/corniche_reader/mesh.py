"""A TIN on the lattice: which triangle contains a point, and which lies beyond an edge. All arithmetic is in integers."""

from __future__ import annotations

from collections import defaultdict

Point = tuple[int, int]
BUCKETS = 64


def orient(a: Point, b: Point, c: Point) -> int:
    """Above 0 where c lies strictly left of a ► b, 0 on the line."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


class Mesh:
    """A triangle mesh with adjacency."""

    def __init__(self, points: list[Point], triangles: list[list[int]]) -> None:
        self.points, self.triangles = points, triangles
        #: The triangle with a directed edge.
        self.on_left: dict[tuple[int, int], int] = {}
        #: Triangles around a vertex, by ascending half-edge that starts there: (triangle, corner).
        self.around: defaultdict[int, list[tuple[int, int]]] = defaultdict(list)
        self._buckets: defaultdict[Point, list[int]] = defaultdict(list)
        self._origin = (min((u for u, _ in points), default=0), min((v for _, v in points), default=0))
        reach = max((max(u - self._origin[0], v - self._origin[1]) for u, v in points), default=0)
        self._side = reach // BUCKETS + 1
        for t, corners in enumerate(triangles):
            for k in range(3):
                self.on_left[corners[k], corners[(k + 1) % 3]] = t
                self.around[corners[k]].append((t, k))
            cells = [self._bucket(points[v]) for v in corners]
            for i in range(min(c for c, _ in cells), max(c for c, _ in cells) + 1):
                for j in range(min(r for _, r in cells), max(r for _, r in cells) + 1):
                    self._buckets[i, j].append(t)

    def _bucket(self, point: Point) -> Point:
        return (point[0] - self._origin[0]) // self._side, (point[1] - self._origin[1]) // self._side

    def near(self, p: Point, q: Point) -> set[int]:
        """The triangles near a segment: all that it meets, and others."""
        (u, v), (to_u, to_v) = sorted((p, q))
        found: set[int] = set()
        first, last = (self._bucket(end)[0] for end in ((u, v), (to_u, to_v)))
        for column in range(max(first, 0), min(last, BUCKETS) + 1):
            left = self._origin[0] + self._side * column
            ends = max(left, u), min(left + self._side, to_u)
            # The quotients are rounded down, so the segment may reach the next row.
            at_ends = [v + (to_v - v) * (at - u) // (to_u - u) for at in ends] if u < to_u else [v, to_v]
            low, high = sorted(self._bucket((u, at))[1] for at in at_ends)
            for row in range(max(low, 0), min(high + 1, BUCKETS) + 1):
                found.update(self._buckets.get((column, row), ()))
        return found

    def locate(self, point: Point) -> int | None:
        """The smallest number of a triangle that contains the point, borders included; None without one."""
        for t in self._buckets.get(self._bucket(point), ()):
            a, b, c = (self.points[v] for v in self.triangles[t])
            if orient(a, b, point) >= 0 and orient(b, c, point) >= 0 and orient(c, a, point) >= 0:
                return t
        return None
