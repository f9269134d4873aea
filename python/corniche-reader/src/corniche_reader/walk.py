"""Decodes the vertices and triangles of a tile's TIN: the bits of positions and the walk (section 5 of the format)."""

from __future__ import annotations

from bisect import bisect_right
from collections import deque
from dataclasses import dataclass, field
from math import ceil, floor, hypot

import numpy as np
from numpy.typing import NDArray

from .codes import Bits, Numbers, half_octave, models

SIDE = 257
CLASSES = [1, 2, 3, 4, 5, 6, 7, 8, 10, 13, 17, 23, 31]


def positions(bits: Bits) -> NDArray[np.int64]:
    """The columns and rows of the vertices, by number."""
    u = [models(64) for _ in range(4)]
    w = [[models(14) for _ in range(14)] for _ in range(4)]
    of = [bisect_right(CLASSES, n) for n in range(61)]
    ones = [n.bit_count() for n in range(32)]
    pad = 5
    nodes = np.zeros((SIDE + 5, SIDE + 2 * pad), np.int64)
    for row in range(SIDE):
        above = nodes[row : row + 5, :]
        wide_rows, near_rows = _before(nodes, row, 5, 5), _before(nodes, row, 2, 3)
        a, d = above[4].tolist(), above[3].tolist()
        history, out = 0, []
        edge = 1 if row in (0, SIDE - 1) else 0
        for column in range(SIDE):
            at = column + pad
            border = edge + (2 if column in (0, SIDE - 1) else 0)
            neighbours = a[at] + 2 * a[at - 1] + 4 * a[at + 1] + 8 * d[at] + 16 * (history & 1) + 32 * (history >> 1 & 1)
            wide, near = wide_rows[column] + ones[history & 31], near_rows[column] + ones[history & 7]
            bit = bits.mixed(u[border][neighbours], w[border][of[wide]][of[near]])
            history = (history << 1 | bit) & 31
            out.append(bit)
        nodes[row + 5, pad : pad + SIDE] = out
    rows, columns = np.nonzero(nodes[5:, pad : pad + SIDE])
    return np.stack([columns, rows], axis=1).astype(np.int64)


def _before(nodes: NDArray[np.int64], row: int, rows: int, reach: int) -> list[int]:
    """For each column, the number of vertices in the `reach` rows above and `reach` columns to both sides."""
    sums = np.concatenate([[0], np.cumsum(nodes[row + 5 - rows : row + 5].sum(axis=0))])
    first = np.arange(SIDE) + 5 - reach
    return list((sums[first + 2 * reach + 1] - sums[first]).tolist())


@dataclass
class Walk:
    """The triangles in the order of discovery, and how each vertex was reached."""

    triangles: list[tuple[int, int, int]] = field(default_factory=list)
    reached: list[tuple[int, tuple[int, int, int] | None]] = field(default_factory=list)


class Guesses:
    """Finds the vertices that see a gate (an edge) under the largest angles."""

    def __init__(self, vertices: NDArray[np.int64], edges: set[tuple[int, int]]) -> None:
        self.edges = edges
        self.numbers = np.full((SIDE, SIDE), -1, np.int64)
        self.numbers[vertices[:, 1], vertices[:, 0]] = np.arange(len(vertices))
        self.columns, self.rows = vertices[:, 0].copy(), vertices[:, 1].copy()
        self.points = vertices.tolist()

    def find(self, a: int, b: int, count: int) -> list[tuple[float, int]]:
        """Up to `count` guesses, and one more if it was found: (dot / cross, vertex).

        Fractions are compared as f64: dot and cross are below 2^18, so different fractions differ by more than 2^-37 of their size.
        """
        (ac, ar), (bc, br) = self.points[a], self.points[b]
        length, mid_c, mid_r = hypot(bc - ac, br - ar), (ac + bc) / 2, (ar + br) / 2
        centre_c, centre_r, reach = mid_c, mid_r, 0.75 * length + 2
        while True:
            c0, c1 = max(floor(centre_c - reach), 0), min(ceil(centre_c + reach), SIDE - 1)
            r0, r1 = max(floor(centre_r - reach), 0), min(ceil(centre_r + reach), SIDE - 1)
            whole = c1 - c0 == SIDE - 1 and r1 - r0 == SIDE - 1
            found = self._inside(a, b, c0, c1, r0, r1, count)
            if whole:
                return found
            if len(found) < count:
                reach, centre_c, centre_r = 2 * reach + 4, mid_c, mid_r
                continue
            # All vertices that see the gate under a larger angle lie in the circle through a, b and
            # the last guess, left of the gate.
            ratio = found[count - 1][0]
            if ratio <= 0:
                cap_c, cap_r, radius = mid_c, mid_r, length / 2
            else:
                # The left of (dx, dy) is (-dy, dx); y is minus the row.
                cap_c, cap_r = mid_c + (br - ar) * ratio / 2, mid_r - (bc - ac) * ratio / 2
                radius = length / 2 * hypot(1.0, ratio)
            radius += 1e-6 * (1 + radius)
            if (
                (c0 == 0 or cap_c - radius >= c0)
                and (c1 == SIDE - 1 or cap_c + radius <= c1)
                and (r0 == 0 or cap_r - radius >= r0)
                and (r1 == SIDE - 1 or cap_r + radius <= r1)
            ):
                return found
            centre_c, centre_r, reach = cap_c, cap_r, radius + 1

    def _inside(self, a: int, b: int, c0: int, c1: int, r0: int, r1: int, count: int) -> list[tuple[float, int]]:
        part = self.numbers[r0 : r1 + 1, c0 : c1 + 1]
        ids = part[part >= 0]
        (ac, ar), (bc, br) = self.points[a], self.points[b]
        x, y = self.columns[ids], self.rows[ids]
        xa, ya = x - ac, y - ar
        cross = (br - ar) * xa - (bc - ac) * ya
        left = cross > 0
        ids, xa, ya, cross = ids[left], xa[left], ya[left], cross[left]
        if not len(ids):
            return []
        ratio = (xa * (xa + (ac - bc)) + ya * (ya + (ar - br))) / cross
        order = np.argsort(ratio, kind="stable")
        found: list[tuple[float, int]] = []
        edges = self.edges
        for i in order:
            c = int(ids[i])
            if (b, c) not in edges and (c, a) not in edges:
                found.append((float(ratio[i]), c))
                if len(found) > count:
                    break
        return found


def walk(bits: Bits, vertices: NDArray[np.int64], count: int) -> Walk:
    """Decodes the triangles."""
    return _Walker(bits, vertices).run(count)


class _Walker:
    def __init__(self, bits: Bits, vertices: NDArray[np.int64]) -> None:
        self.bits, self.total = bits, len(vertices)
        self.edges: set[tuple[int, int]] = set()
        self.guesses = Guesses(vertices, self.edges)
        self.points = self.guesses.points
        self.named = Numbers(bits, 1, 1)
        self.met = [0] * self.total
        self.i = [[models(6) for _ in range(2)] for _ in range(5)]
        self.j = [[models(16) for _ in range(2)] for _ in range(5)]
        self.n = [models(16) for _ in range(5)]
        self.r = [models(5) for _ in range(2)]
        self.seen = [False] * self.total
        self.out = Walk()
        self.queue: deque[tuple[int, int, int]] = deque()

    def run(self, count: int) -> Walk:
        start = 0
        while len(self.out.triangles) < count:
            if not self.queue:
                start += self._name()
                a, b, c = start, start + 1 + self._name(), start + 1 + self._name()
                self._add(a, b, c, None)
                self.queue.extend([(b, a, c), (c, b, a), (a, c, b)])
                continue
            a, b, d = self.queue.popleft()
            if (a, b) in self.edges:
                continue
            found = self._third(a, b, d)
            if found is not None:
                self._add(a, b, found, d)
                self.queue.extend([(found, b, a), (a, found, b)])
        for vertex in range(self.total):
            self._reach(vertex, None)
        return self.out

    def _name(self) -> int:
        number = self.named.read()
        if number < 0:
            raise self.bits.error("a vertex number is negative")
        return number

    def _reach(self, vertex: int, gate: tuple[int, int, int] | None) -> None:
        if not self.seen[vertex]:
            self.seen[vertex] = True
            self.out.reached.append((vertex, gate))

    def _add(self, a: int, b: int, c: int, d: int | None) -> None:
        if max(a, b, c) >= self.total:
            raise self.bits.error("a triangle has a vertex that does not exist")
        if len({a, b, c}) < 3 or self._cross(a, b, c) <= 0 or self.edges & {(a, b), (b, c), (c, a)}:
            raise self.bits.error("a triangle is degenerate, clockwise or overlaps another")
        self.edges |= {(a, b), (b, c), (c, a)}
        self.out.triangles.append((a, b, c))
        for vertex in (a, b, c):
            self._reach(vertex, None if d is None else (a, b, d))

    def _cross(self, a: int, b: int, c: int) -> int:
        (ac, ar), (bc, br), (cc, cr) = self.points[a], self.points[b], self.points[c]
        return int((br - ar) * (cc - ac) - (bc - ac) * (cr - ar))

    def _dot(self, a: int, b: int, c: int) -> int:
        (ac, ar), (bc, br), (cc, cr) = self.points[a], self.points[b], self.points[c]
        return int((ac - cc) * (bc - cc) + (ar - cr) * (br - cr))

    def _third(self, a: int, b: int, d: int) -> int | None:
        found = self.guesses.find(a, b, 1)
        if not found:
            return None
        tied = int(len(found) > 1 and found[1][0] == found[0][0])
        c = found[0][1]
        symbol = self._symbol(a, b, c, d, tied)
        if symbol == 0:
            return None
        if symbol == 1:
            return c
        if symbol == 7:
            return self._name()
        found = self.guesses.find(a, b, symbol)
        if len(found) < symbol:
            raise self.bits.error(f"guess {symbol} at a gate does not exist")
        return found[symbol - 1][1]

    def _symbol(self, a: int, b: int, c: int, d: int, tied: int) -> int:
        (ac, ar), (bc, br) = self.points[a], self.points[b]
        length = min(half_octave((bc - ac) ** 2 + (br - ar) ** 2), 6) - 1
        history = self.met[a] + 4 * self.met[b]
        cross, cross_d = self._cross(a, b, c), self._cross(b, a, d)
        s = self._dot(a, b, d) * cross + self._dot(a, b, c) * cross_d
        t = cross * cross_d
        if s == 0:
            shape = 2
        elif s > 0:
            shape = 0 if 4 * s >= t else 1
        else:
            shape = 3 if 2 * s > -t else 4
        if not self.bits.mixed(self.i[shape][tied][length], self.j[shape][tied][history]):
            return 1
        if self.bits.bit(self.n[shape][history]):
            symbol = 0
        else:
            symbol = 2
            for model in self.r[tied]:
                if not self.bits.bit(model):
                    break
                symbol += 1
        for vertex in (a, b):
            self.met[vertex] |= 2 if symbol else 1
        return symbol
