"""The ground of a tile: heights and the vertices of lines on it (section 7 of the format, *Positions*)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .grid import Grid, TileName
from .mesh import Mesh, Point, orient
from .terrain import Terrain

#: A position on the lattice, and the height in metres.
Vertex = tuple[float, float, float]


@dataclass(frozen=True)
class Ground:
    """The triangles of a tile."""

    mesh: Mesh
    heights_m: list[float]

    @classmethod
    def of(cls, terrain: Terrain, grid: Grid, tile: TileName) -> Ground:
        """Places the triangles of a tile on the lattice."""
        lattice = [grid.lattice_of_node(tile, int(c), int(r)) for c, r in terrain.vertices.tolist()]
        return cls(Mesh(lattice, terrain.triangles.tolist()), (terrain.heights_q.astype(np.float64) * grid.quantum_m).tolist())

    def height_m(self, point: Point) -> float | None:
        """The height at a lattice point; None where the tile has no ground."""
        triangle = self.mesh.locate(point)
        return None if triangle is None else self.height_in(triangle, point)

    def height_in(self, triangle: int, point: Point) -> float:
        """The height at a lattice point in a triangle."""
        a, b, c = self.mesh.triangles[triangle]
        at, h = self.mesh.points, self.heights_m
        bu, bv = float(at[b][0] - at[a][0]), float(at[b][1] - at[a][1])
        cu, cv = float(at[c][0] - at[a][0]), float(at[c][1] - at[a][1])
        du, dv = float(point[0] - at[a][0]), float(point[1] - at[a][1])
        total = (bu * cv) - (bv * cu)
        return h[a] + (((((du * cv) - (dv * cu)) / total) * (h[b] - h[a])) + ((((bu * dv) - (bv * du)) / total) * (h[c] - h[a])))

    def source(self, point: Point, triangle: int) -> Vertex:
        """The vertex of a line at one of its points, which is in this triangle."""
        return float(point[0]), float(point[1]), self.height_in(triangle, point)

    def vertex(self, number: int) -> Vertex:
        """The vertex of a line at a TIN vertex."""
        u, v = self.mesh.points[number]
        return float(u), float(v), self.heights_m[number]

    def crossing(self, a: int, b: int, p: Point, q: Point) -> Vertex:
        """The vertex of a line where its segment p ► q crosses the edge between the TIN vertices a < b."""
        sa, sb = orient(p, q, self.mesh.points[a]), orient(p, q, self.mesh.points[b])
        near, far, s_near, s_far = (a, b, sa, sb) if abs(sa) <= abs(sb) else (b, a, sb, sa)
        t = float(s_near) / float(s_near - s_far)
        (un, vn), (uf, vf) = self.mesh.points[near], self.mesh.points[far]
        hn, hf = self.heights_m[near], self.heights_m[far]
        return float(un) + (t * float(uf - un)), float(vn) + (t * float(vf - vn)), hn + (t * (hf - hn))


def tiles_at(grid: Grid, level: int, point: Point) -> list[TileName]:
    """The tiles of a level that contain a lattice point: several on their borders."""
    (left, top), side = grid.lattice_of_node((0, 0, 0), 0, 0), 256 << grid.max_level - level
    columns = _tiles_along(point[0] - left, side * grid.steps[0], 1 << level)
    rows = _tiles_along(top - point[1], side * grid.steps[1], 1 << level)
    return [(level, x, y) for y in rows for x in columns]


def _tiles_along(steps: int, side: int, count: int) -> list[int]:
    """Along one axis: the number of the tile at `steps` from the origin, and of the one before it if this is their border."""
    tile, rest = divmod(steps, side)
    return [at for at in ([tile] if rest else [tile, tile - 1]) if 0 <= at < count]
