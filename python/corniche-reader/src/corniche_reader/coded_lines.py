"""Decodes lines of a class from range-coded bits (coded road sections of the format)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from .codes import Bits, Numbers, models
from .errors import PayloadError
from .grid import Grid
from .mesh import Point
from .steps import Steps

#: A surprise: the number of vertices before it that are as guessed, and its fields.
Surprise = tuple[int, tuple[int, ...]]
#: Limits for a class: points, vertices that are not as guessed, lines.
MOST, MOST_LINES = 1 << 22, 1 << 20


@dataclass
class Line:
    """The head and the points of a line."""

    way_id: int
    part: int
    flags: int
    points: list[Point]


def coded_lines(data: bytes, count: int, step_m: tuple[float, float], grid: Grid, what: str) -> list[tuple[Line, list[Surprise]]]:
    """All lines of a class of GEO roads, with their surprises."""
    if (count == 0) != (len(data) == 0) or count > MOST_LINES:
        raise PayloadError(f"{what}: the table of classes is invalid")
    if count == 0:
        return []
    bits = Bits(data, what)
    lines = list(_Class(bits, step_m, grid).lines(count))
    bits.end()
    return lines


class _Class:
    """The models of a class, and the state of its decoder."""

    def __init__(self, bits: Bits, step_m: tuple[float, float], grid: Grid) -> None:
        self.bits, self.step_m, self.grid = bits, step_m, grid
        self.ids, self.parts, self.sizes, self.back = (Numbers(bits, 1, 1) for _ in range(4))
        self.starts = Numbers(bits, 1, 1), Numbers(bits, 1, 1)
        self.beside = Numbers(bits, 1, 1), Numbers(bits, 1, 1)
        self.steps = Steps(bits)
        self.flags, self.off = models(2), models(1)[0]
        self.same = [models(2) for _ in range(3)]
        self.counts, self.gaps, self.indices = Numbers(bits, 4, 1), Numbers(bits, 1, 1), Numbers(bits, 1, 1)
        self.kinds = models(4)
        self.at: Point = (0, 0)
        self.new: list[tuple[Point, Point]] = []
        self.surprises = 0

    def lines(self, count: int) -> Iterator[tuple[Line, list[Surprise]]]:
        """Decodes `count` lines."""
        way, left = 0, MOST
        last: tuple[int, int] | None = None
        for _ in range(count):
            way += self.ids.read()
            part, size = self.parts.unsigned(), self.sizes.unsigned()
            flags = self.bits.bit(self.flags[0]) | self.bits.bit(self.flags[1]) << 1
            left -= size
            if left < 0:
                raise self.bits.error("too many points")
            if last is not None and (way, part) <= last:
                raise self.bits.error("lines are not sorted")
            last = way, part
            points = list(self._points(size))
            if any(a == b for a, b in pairwise(points)):
                raise self.bits.error("a segment of length 0")
            yield Line(way, part, flags, points), self._surprises(flags)

    def _points(self, size: int) -> Iterator[Point]:
        before, was = (0, 0), 0
        for i in range(size):
            place = 0 if i == 0 else 1 if i + 1 < size else 2
            last = self.at
            was = self.bits.bit(self.same[place][was])
            if was:
                back = self.back.unsigned()
                if back >= len(self.new):
                    raise self.bits.error("a reference to a point that does not exist")
                self.at, point = self.new[-1 - back]
            else:
                step = tuple(kind.read() for kind in self.starts) if i == 0 else self.steps.read(before)
                self.at = last[0] + step[0], last[1] + step[1]
                if max(map(abs, self.at)) > 1 << 33:
                    raise self.bits.error("a point is too far away")
                u, v = self.grid.snap(self.at[0] * self.step_m[0], self.at[1] * self.step_m[1])
                if self.bits.bit(self.off):
                    u, v = u + self.beside[0].read(), v + self.beside[1].read()
                point = u, v
                self.new.append((self.at, point))
            before = (0, 0) if i == 0 else (self.at[0] - last[0], self.at[1] - last[1])
            yield point

    def _surprises(self, flags: int) -> list[Surprise]:
        count = self.counts.unsigned(flags)
        self.surprises += count
        if self.surprises > MOST:
            raise self.bits.error("too many surprises")
        found = []
        for _ in range(count):
            gap = self.gaps.unsigned()
            high = self.bits.bit(self.kinds[1])
            kind = 2 * high + self.bits.bit(self.kinds[2 + high])
            found.append((gap, (kind, *(self.indices.unsigned() for _ in range((0, 1, 2, 1)[kind])))))
        return found
