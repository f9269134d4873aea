"""The grid and the lattice of a package (section 2 of the format)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .codes import round_half_away
from .errors import ContainerError, PayloadError


@dataclass(frozen=True)
class Grid:
    """Where nodes and lattice points lie, and how high a height step is."""

    origin_m: tuple[float, float]
    cell_m: tuple[float, float]
    root_corner: tuple[int, int]
    max_level: int
    #: Lattice steps to a cell, east and north.
    steps: tuple[int, int]
    quantum_m: float

    @classmethod
    def of(cls, manifest: dict[str, Any]) -> Grid:
        """Reads it from the manifest."""
        try:
            frame = manifest["frame"]
            origin, cell, corner = frame["origin_m"], frame["cell_m"], frame["root_corner"]
            east, north, quantum = float(cell[0]), float(cell[1]), float(manifest["vertical"]["quantum_m"])
            place = (float(origin[0]), float(origin[1])), (int(corner["i"]), int(corner["j"]))
            level = int(frame["max_level"])
        except (KeyError, TypeError, ValueError, IndexError) as cause:
            raise ContainerError(f"the manifest lacks a number that a reader needs: {cause}") from cause
        if not (0 < north < 1e18 and 0 < east < 1e18 and quantum > 0 and 0 <= level <= 31):
            raise ContainerError("the manifest's cells, quantum or levels are beyond their limits")
        b = 0
        while north / 2**b > 0.001:
            b += 1
        a = east / (north / 2**b)
        if a != int(a) or a < 1:
            raise ContainerError("the east side of a cell is not a whole number of lattice steps")
        return cls(place[0], (east, north), place[1], level, (int(a), 2**b), quantum)

    def level_cell_m(self, level: int) -> tuple[float, float]:
        """Sides of a cell of this level."""
        s = 1 << self.max_level - level
        return self.cell_m[0] * s, self.cell_m[1] * s

    def lattice_of_node(self, tile: tuple[int, int, int], column: int, row: int) -> tuple[int, int]:
        """The lattice point of a tile's node."""
        z, x, y = tile
        s = 1 << self.max_level - z
        return (
            (self.root_corner[0] + s * (256 * x + column)) * self.steps[0],
            (self.root_corner[1] - s * (256 * y + row)) * self.steps[1],
        )

    def snap(self, x: float, y: float) -> tuple[int, int]:
        """The lattice point nearest to a place in working metres."""
        u = (x - self.origin_m[0]) / self.cell_m[0] * self.steps[0]
        v = (y - self.origin_m[1]) / self.cell_m[1] * self.steps[1]
        # No comparison is true for what is no number.
        if not (abs(u) < 1 << 50 and abs(v) < 1 << 50):
            raise PayloadError("a point of a road lies beyond the lattice")
        return round_half_away(u), round_half_away(v)

    def working(self, u: float, v: float) -> tuple[float, float]:
        """Working metres of a place on the lattice."""
        return (
            self.origin_m[0] + self.cell_m[0] * (u / float(self.steps[0])),
            self.origin_m[1] + self.cell_m[1] * (v / float(self.steps[1])),
        )
