"""Least-cost roads over a raster (after Galin et al. 2010, *Procedural Generation of Roads*).

A state is a cell and the heading it was reached with, so that turning has a price; a road too steep to go
straight up then makes few long hairpins instead of many short zigzags.
"""

import heapq
import math

import numpy as np

from noise import box_blur

GRID_M = 40.0
# Sixteen headings in order of angle.
STEPS = [
    (1, 0), (2, 1), (1, 1), (1, 2), (0, 1), (-1, 2), (-1, 1), (-2, 1),
    (-1, 0), (-2, -1), (-1, -1), (-1, -2), (0, -1), (1, -2), (1, -1), (2, -1),
]  # fmt: skip


class Ground:
    """Heights at the routing grid and the cells no road may use."""

    def __init__(self, z, cell_m, water):
        k = int(GRID_M / cell_m)
        self.side = z.shape[0] // k
        self.z = box_blur(z, 1)[k // 2 :: k, k // 2 :: k]
        gy, gx = np.gradient(box_blur(z, 2), cell_m)
        self.slope = np.sqrt(gx * gx + gy * gy)[k // 2 :: k, k // 2 :: k].tolist()
        self.flat = self.z.tolist()
        blocked = box_blur(water.astype(np.float64), 2) > 0.01
        self.blocked = blocked[k // 2 :: k, k // 2 :: k].tolist()

    def cell(self, point):
        """Routing cell (row, col) under a point."""
        return int(point[1] // GRID_M), int(point[0] // GRID_M)

    def route(self, start, goals, easy_grade, max_grade, turn_m, aim=None):
        """Cheapest way from `start` to any cell in `goals`; points in metres, ends at cell centres.

        A metre at `easy_grade` counts two; beyond `max_grade` it soon counts dozens. `turn_m` is the price
        of 22.5° of turning. `aim` directs the search towards one point.
        """
        row, col = self.cell(start)
        heap = [(0.0, 0.0, row, col, -1)]
        done, came = set(), {}
        best = {}
        while heap:
            _, cost, r, c, heading = heapq.heappop(heap)
            key = (r, c, heading)
            if key in done:
                continue
            done.add(key)
            if (r, c) in goals:
                return self._trace(came, key)
            for k, (dc, dr) in enumerate(STEPS):
                rr, cc = r + dr, c + dc
                if not (0 <= rr < self.side and 0 <= cc < self.side) or (
                    self.blocked[rr][cc] and (rr, cc) not in goals
                ):
                    continue
                turn = 0
                if heading >= 0:
                    turn = abs(k - heading)
                    turn = min(turn, 16 - turn)
                    if turn > 7:
                        continue
                length = GRID_M * math.sqrt(dc * dc + dr * dr)
                grade = abs(self.flat[rr][cc] - self.flat[r][c]) / length
                price = 1.0 + (grade / easy_grade) * (grade / easy_grade) + 0.6 * self.slope[rr][cc]
                if grade > max_grade:
                    price += 60.0 * (grade - max_grade) / max_grade
                total = cost + length * price + turn_m * turn
                other = (rr, cc, k)
                if other not in done and total < best.get(other, 1e18):
                    best[other], came[other] = total, key
                    rest = 0.0
                    if aim is not None:
                        ex, ey = (cc + 0.5) * GRID_M - aim[0], (rr + 0.5) * GRID_M - aim[1]
                        rest = 1.2 * math.sqrt(ex * ex + ey * ey)
                    heapq.heappush(heap, (total + rest, total, rr, cc, k))
        raise ValueError(f"no way from {start}")

    @staticmethod
    def _trace(came, key):
        out = [key]
        while key in came:
            key = came[key]
            out.append(key)
        return [((c + 0.5) * GRID_M, (r + 0.5) * GRID_M) for r, c, _ in reversed(out)]


def smooth(points, rounds=2):
    """Chaikin's corner cutting; ends stay."""
    for _ in range(rounds):
        out = [points[0]]
        for (ax, ay), (bx, by) in zip(points[:-1], points[1:]):
            out.append((0.75 * ax + 0.25 * bx, 0.75 * ay + 0.25 * by))
            out.append((0.25 * ax + 0.75 * bx, 0.25 * ay + 0.75 * by))
        points = [*out, points[-1]]
    return points


def simplify(points, tolerance_m):
    """Douglas & Peucker 1973, ends kept."""
    keep, stack = {0, len(points) - 1}, [(0, len(points) - 1)]
    while stack:
        a, b = stack.pop()
        (ax, ay), (bx, by) = points[a], points[b]
        length = math.sqrt((bx - ax) * (bx - ax) + (by - ay) * (by - ay))
        worst, at = tolerance_m, None
        for k in range(a + 1, b):
            px, py = points[k]
            if length > 0:
                off = abs((bx - ax) * (py - ay) - (by - ay) * (px - ax)) / length
            else:
                off = math.sqrt((px - ax) * (px - ax) + (py - ay) * (py - ay))
            if off > worst:
                worst, at = off, k
        if at is not None:
            keep.add(at)
            stack += [(a, at), (at, b)]
    return [points[k] for k in sorted(keep)]
