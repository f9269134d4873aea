"""Points of lines, stored as differences to the previous point (item 4 of section 6 of the format)."""

from __future__ import annotations

from .codes import Cursor, unzigzag
from .mesh import Point

#: The largest number of points of all lines of a section (section 11 of the format).
MOST_POINTS = 1 << 22


def lattice_points(cursor: Cursor, sizes: list[int], corner: Point) -> list[list[Point]]:
    """The points of lines with the given numbers of points; the very first point is relative to the tile's corner."""
    total = sum(sizes)
    if total > MOST_POINTS:
        raise cursor.error("too many points")
    du, dv = cursor.planes(total), cursor.planes(total)
    (u, v), at, lines = corner, 0, []
    for size in sizes:
        points = []
        for i in range(at, at + size):
            u, v = u + unzigzag(du[i]), v + unzigzag(dv[i])
            points.append((u, v))
        lines.append(points)
        at += size
    return lines
