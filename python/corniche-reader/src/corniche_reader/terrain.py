"""The section of terrain (section 5 of the format): decodes heights and normals, and assembles the TIN."""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .codes import Bits, Cursor, Numbers, half_octave, round_half_away
from .grid import Grid, TileName
from .walk import Walk, positions, walk


@dataclass(frozen=True)
class Terrain:
    """The ground of a tile."""

    geometric_error_m: float
    #: The lowest and the highest full-resolution node within the tile.
    height_range_m: tuple[float, float]
    uncovered_nodes: int
    #: The [column, row] of each vertex.
    vertices: NDArray[np.int64]
    #: Heights in steps of the package's height quantum.
    heights_q: NDArray[np.int64]
    #: [x, y, z] of each vertex: working metres, and the height in metres.
    positions: NDArray[np.float64]
    # : The three vertex numbers of each triangle, counter-clockwise, the smallest first; triangles
    # are sorted.
    triangles: NDArray[np.int64]
    #: Octahedron-coded normals: two values from −128 to 127.
    normal_codes: NDArray[np.int8]

    @property
    def heights_m(self) -> NDArray[np.float64]:
        """The heights of the vertices in metres."""
        heights: NDArray[np.float64] = self.positions[:, 2]
        return heights

    @property
    def normals(self) -> NDArray[np.float64]:
        """The unit normals [x, y, z] of the vertices."""
        xy = self.normal_codes.astype(np.float64) / 127.0
        xyz = np.column_stack([xy, 1.0 - np.abs(xy).sum(axis=1)])
        unit: NDArray[np.float64] = xyz / np.linalg.norm(xyz, axis=1, keepdims=True)
        return unit


def read_terrain(data: bytes, grid: Grid, tile: TileName) -> Terrain:
    """Decodes the section of terrain."""
    what = "terrain of tile {}/{}/{}".format(*tile)
    cursor = Cursor(data, what)
    error_m, low_m, high_m = struct.unpack("<3d", cursor.take(24))
    uncovered, count = cursor.varint(), cursor.varint()
    height_shift, normal_shift = cursor.byte(), cursor.byte()
    if not all(map(math.isfinite, (error_m, low_m, high_m))) or height_shift > 31 or normal_shift > 7 or count > 2 * 256**2:
        raise cursor.error("numbers before the bits are beyond their limits")
    bits = Bits(data[cursor.at :], what)
    vertices = positions(bits)
    found = walk(bits, vertices, count)
    points = vertices.tolist()
    heights = [height << height_shift for height in _heights(bits, points, found)]
    codes = _normals(bits, points, found, heights, normal_shift, grid.quantum_m, grid.level_cell_m(tile[0]))
    bits.end()
    triangles = sorted(min(t, (t[1], t[2], t[0]), (t[2], t[0], t[1])) for t in found.triangles)
    heights_q = np.array(heights, np.int64)
    places = np.empty((len(points), 3))
    for i, (column, row) in enumerate(points):
        places[i, :2] = grid.working(*map(float, grid.lattice_of_node(tile, column, row)))
    places[:, 2] = heights_q.astype(np.float64) * grid.quantum_m
    return Terrain(
        error_m, (low_m, high_m), uncovered, vertices, heights_q, places, np.array(triangles, np.int64).reshape(-1, 3), codes
    )


def _heights(bits: Bits, points: Sequence[Sequence[int]], found: Walk) -> list[int]:
    numbers = Numbers(bits, 40, 64)
    heights, magnitudes = [0] * len(points), [0] * len(points)
    before = 0
    for v, gate in found.reached:
        if gate is None:
            guess, first, second = before, 39, 63
        else:
            a, b, d = gate
            around = (heights[a], heights[b], heights[d])
            guess = min(max((3 * (around[0] + around[1]) - 2 * around[2]) // 4, -(1 << 31)), (1 << 31) - 1)
            first = half_octave(magnitudes[a] + magnitudes[b] + magnitudes[d])
            away = sum((2 * points[v][k] - points[a][k] - points[b][k]) ** 2 for k in (0, 1))
            second = min(half_octave(max(around) - min(around)) // 3, 7) + 8 * min(half_octave(away) // 4, 6)
        number = numbers.read(first, second)
        before = heights[v] = guess + number
        magnitudes[v] = abs(number)
        if not -(1 << 31) <= before < 1 << 31:
            raise bits.error("a height is beyond 32 bits")
    return heights


def _normal_guesses(
    points: Sequence[Sequence[int]], found: Walk, heights: list[int], shift: int, quantum_m: float, cell_m: tuple[float, float]
) -> list[tuple[int, int]]:
    sums = [[0, 0, 0] for _ in points]
    for p, q, r in found.triangles:
        (pc, pr), (qc, qr), (rc, rr) = points[p], points[q], points[r]
        ax, ay, az = qc - pc, pr - qr, heights[q] - heights[p]
        bx, by, bz = rc - pc, pr - rr, heights[r] - heights[p]
        cross = (ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
        for v in (p, q, r):
            for k in (0, 1, 2):
                sums[v][k] += cross[k]
    guesses = []
    for sx, sy, sz in sums:
        x, y, z = float(sx) * (quantum_m / cell_m[0]), float(sy) * (quantum_m / cell_m[1]), float(sz)
        total = abs(x) + abs(y) + z
        if total == 0:
            guesses.append((0, 0))
        else:
            scale = 127 / (1 << shift)
            guesses.append((round_half_away(x / total * scale), round_half_away(y / total * scale)))
    return guesses


def _normals(
    bits: Bits,
    points: Sequence[Sequence[int]],
    found: Walk,
    heights: list[int],
    shift: int,
    quantum_m: float,
    cell_m: tuple[float, float],
) -> NDArray[np.int8]:
    guesses = _normal_guesses(points, found, heights, shift, quantum_m, cell_m)
    east, north = Numbers(bits, 24, 48), Numbers(bits, 24, 48)
    sizes = [0] * len(points)
    codes = np.zeros((len(points), 2), np.uint8)
    for v, gate in found.reached:
        a, b, d = gate or (v, v, v)
        gx, gy = guesses[v]
        first = half_octave(sizes[a] + sizes[b] + sizes[d])
        bend = min(half_octave(sum(abs(guesses[k][0] - gx) + abs(guesses[k][1] - gy) for k in (a, b, d))) // 2, 7)
        e = east.read(first, bend)
        n = north.read(first, bend + 8 * min((half_octave(abs(e)) + 1) // 2, 5))
        sizes[v] = min(abs(e), 255) + min(abs(n), 255)
        codes[v] = ((gx + e) << shift) & 255, ((gy + n) << shift) & 255
    return codes.view(np.int8)
