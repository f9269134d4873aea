"""The grid and the lattice of a package (section 2 of the format)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .codes import round_half_away
from .errors import ContainerError, PayloadError

#: A tile: z, x, y.
TileName = tuple[int, int, int]
#: The largest coordinate of a position in working metres (section 11 of the format).
FARTHEST_M = 2**51 / 1000
# : The largest distance of a lattice point from node (0, 0), in steps, and the limit of node
# indices.
MOST_STEPS, MOST_NODES = 1 << 50, 1 << 32
#: The largest number of levels below the root.
MOST_LEVELS = 22


@dataclass(frozen=True)
class Grid:
    """The positions of nodes and lattice points, and the height of a height step."""

    origin_m: tuple[float, float]
    cell_m: tuple[float, float]
    root_corner: tuple[int, int]
    max_level: int
    #: Lattice steps per cell, east and north.
    steps: tuple[int, int]
    quantum_m: float

    @classmethod
    def of(cls, manifest: dict[str, Any]) -> Grid:
        """Reads the grid from the manifest."""
        try:
            frame = manifest["frame"]
            origin, cell, corner = frame["origin_m"], frame["cell_m"], frame["root_corner"]
            east, north, quantum = float(cell[0]), float(cell[1]), float(manifest["vertical"]["quantum_m"])
            place = (float(origin[0]), float(origin[1])), (int(corner["i"]), int(corner["j"]))
            level = int(frame["max_level"])
        except (KeyError, TypeError, ValueError, IndexError, OverflowError) as cause:
            raise ContainerError(f"the manifest lacks a number that a reader needs: {cause}") from cause
        # Comparisons with NaN are false.
        if not (0.001 <= north <= 1e6 and 0.001 <= east <= 1e6 and 0 <= level <= MOST_LEVELS):
            raise ContainerError("the manifest's cells or levels are beyond their limits")
        if not all(abs(metres) <= FARTHEST_M for metres in place[0]):
            raise ContainerError("the origin of the manifest's grid is beyond its limits")
        if not (2.0**-64 <= quantum <= 2.0**27 and math.frexp(quantum)[0] == 0.5):
            raise ContainerError("the manifest's height quantum is not a power of two from 2^-64 to 2^27")
        b = 0
        while north / 2**b > 0.001:
            b += 1
        a = east / (north / 2**b)
        if a != int(a) or a < 1:
            raise ContainerError("the east side of a cell is not a whole number of lattice steps")
        reach = max(map(abs, place[1])) + (256 << level)
        if reach > MOST_NODES or reach * max(int(a), 2**b) > MOST_STEPS:
            raise ContainerError("the manifest's grid reaches beyond its limits")
        return cls(place[0], (east, north), place[1], level, (int(a), 2**b), quantum)

    def level_cell_m(self, level: int) -> tuple[float, float]:
        """The sides of a cell of this level, in metres."""
        s = 1 << self.max_level - level
        return self.cell_m[0] * s, self.cell_m[1] * s

    def lattice_of_node(self, tile: TileName, column: int, row: int) -> tuple[int, int]:
        """The lattice point of a tile's node."""
        z, x, y = tile
        s = 1 << self.max_level - z
        return (
            (self.root_corner[0] + s * (256 * x + column)) * self.steps[0],
            (self.root_corner[1] - s * (256 * y + row)) * self.steps[1],
        )

    def snap(self, x: float, y: float) -> tuple[int, int]:
        """The lattice point nearest to a position in working metres."""
        u = (x - self.origin_m[0]) / self.cell_m[0] * self.steps[0]
        v = (y - self.origin_m[1]) / self.cell_m[1] * self.steps[1]
        # Comparisons with NaN are false.
        if not (abs(u) < MOST_STEPS and abs(v) < MOST_STEPS):
            raise PayloadError("a point of a road lies beyond the lattice")
        return round_half_away(u), round_half_away(v)

    def working(self, u: float, v: float) -> tuple[float, float]:
        """The working metres of a position on the lattice."""
        return (
            self.origin_m[0] + self.cell_m[0] * (u / float(self.steps[0])),
            self.origin_m[1] + self.cell_m[1] * (v / float(self.steps[1])),
        )
