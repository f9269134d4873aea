"""Rings of areas as range-coded bits (layer sections of the format)."""

from __future__ import annotations

from .codes import Bits, Numbers, models
from .mesh import Point
from .steps import Steps


class Rings:
    """The state of the decoder of all rings of a section."""

    def __init__(self, bits: Bits, spacing: int, corners: tuple[Point, Point]) -> None:
        self.bits, self.spacing, (self.low, self.high) = bits, spacing, corners
        self.is_on, self.is_back, self.goes_on, self.is_beside = models(4)
        self.is_known = [models(2) for _ in range(3)]
        self.back = Numbers(bits, 1, 1)
        self.starts = Numbers(bits, 1, 1), Numbers(bits, 1, 1)
        self.beside = Numbers(bits, 1, 1), Numbers(bits, 1, 1)
        self.steps = Steps(bits)
        self.points: list[Point] = []
        #: For each point the ring that it is in.
        self.ring_of: list[int] = []
        #: The first point of each whole ring, and one past its last point.
        self.whole: list[tuple[int, int]] = []
        self.at: Point = self._coarse(self.low)

    def read(self, size: int) -> list[Point]:
        """The points of the next ring."""
        begin = len(self.points)
        before: Point = (0, 0)
        #: The number of the point before, if it occurred before, and the direction in which it was
        #: found: 1 on, -1 back, 0 if it was found by its number.
        known: tuple[int, int] | None = None
        for i in range(size):
            known = self._neighbour_of(known) or self._known(known, i == 0)
            point = self._new(before, i == 0) if known is None else self.points[known[0]]
            if not all(low <= part <= high for low, part, high in zip(self.low, point, self.high, strict=True)):
                raise self.bits.error("a point outside the tile")
            to = self._coarse(point)
            before = (to[0] - self.at[0], to[1] - self.at[1]) if i else (0, 0)
            self.at = to
            self.points.append(point)
            self.ring_of.append(len(self.whole))
        self.whole.append((begin, len(self.points)))
        return self.points[begin:]

    def _coarse(self, point: Point) -> Point:
        return point[0] // self.spacing, point[1] // self.spacing

    def _neighbour_of(self, known: tuple[int, int] | None) -> tuple[int, int] | None:
        """The neighbour of a known point, if the next point is one."""
        if known is None or self.ring_of[known[0]] == len(self.whole):
            return None
        number, way = known
        begin, end = self.whole[self.ring_of[number]]
        for direction in (way,) if way else (1, -1):
            model = self.goes_on if way else self.is_on if direction > 0 else self.is_back
            if self.bits.bit(model):
                return begin + (number - begin + direction) % (end - begin), direction
        return None

    def _known(self, before: tuple[int, int] | None, is_first: bool) -> tuple[int, int] | None:
        """The point that the next one repeats, if it repeats one."""
        found = 0 if before is None else 2 if before[1] else 1
        if not self.bits.bit(self.is_known[found][is_first]):
            return None
        number = len(self.points) - 1 - self.back.unsigned()
        if number < 0:
            raise self.bits.error("a reference to a point that does not exist")
        return number, 0

    def _new(self, before: Point, is_first: bool) -> Point:
        east, north = (kind.read() for kind in self.starts) if is_first else self.steps.read(before)
        u, v = (self.at[0] + east) * self.spacing, (self.at[1] + north) * self.spacing
        if self.bits.bit(self.is_beside):
            u, v = u + self.beside[0].unsigned(), v + self.beside[1].unsigned()
        return u, v
