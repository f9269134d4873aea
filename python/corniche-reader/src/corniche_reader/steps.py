"""Steps from one point of a line or a ring to the next, as range-coded bits (section 9 of the format, *A step*)."""

from __future__ import annotations

from .codes import Bits, Numbers, models
from .mesh import Point


class Steps:
    """The models for steps."""

    def __init__(self, bits: Bits) -> None:
        self.bits = bits
        self.along, self.across = Numbers(bits, 33, 5), Numbers(bits, 100, 33)
        self.negative_along = [models(4) for _ in range(5)]
        self.negative_across = [[models(7), models(7)] for _ in range(5)]

    def read(self, before: Point) -> Point:
        """The next step; `before` is the step before it, (0, 0) if there is none."""
        long, short = sorted(map(abs, before), reverse=True)
        slope = 1 + min(4 * short // long, 3) if long else 0
        along = self.along.unsigned(long.bit_length(), slope)
        across = self.across.unsigned(5 * min(along.bit_length(), 19) + slope, long.bit_length())
        back = 0
        if along:
            back = self.bits.bit(self.negative_along[slope][min(max(along.bit_length() + 2 - long.bit_length(), 0), 3)])
        side = 0
        if across:
            size = min(max(across.bit_length() + 3 - along.bit_length(), 0), 6)
            side = self.bits.bit(self.negative_across[slope][back][size])
        step = -along if back else along, -across if side else across
        if abs(before[1]) > abs(before[0]):
            step = step[1], step[0]
        return -step[0] if before[0] < 0 else step[0], -step[1] if before[1] < 0 else step[1]
