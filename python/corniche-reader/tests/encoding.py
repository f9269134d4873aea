"""Writes what the reader reads, by the format: codes, payloads, packages, and sections of layers."""

from __future__ import annotations

import gzip
import json
import struct
import zlib
from collections.abc import Iterable

from corniche_reader import Package
from corniche_reader.codes import LARGEST, LEAST, learn, models
from corniche_reader.container import tile_number

Point = tuple[int, int]


def varint(number: int) -> bytes:
    found = bytearray()
    while number > 127:
        found.append(number & 127 | 128)
        number >>= 7
    return bytes([*found, number])


def planes(numbers: Iterable[int]) -> bytes:
    numbers = list(numbers)
    width = (max(numbers, default=0).bit_length() + 7) // 8
    return bytes([width, *(number >> 8 * plane & 255 for plane in range(width) for number in numbers)])


def signed(number: int) -> int:
    """The zigzag code."""
    return 2 * number if number >= 0 else -2 * number - 1


def payload(tile: tuple[int, int, int], sections: dict[int, bytes], version: int = 2) -> bytes:
    """A payload of uncompressed sections (section 3 of the format)."""
    z, x, y = tile
    table, at = struct.pack("<4sHBBII", b"CRNT", version, len(sections), z, x, y), 16 + 20 * len(sections) + 4
    for kind, content in sections.items():
        table += struct.pack("<HBBIIII", kind, 0, 0, at, len(content), len(content), zlib.crc32(content))
        at += len(content)
    return table + zlib.crc32(table).to_bytes(4, "little") + b"".join(sections.values())


def package_of(package: Package, tile: tuple[int, int, int], content: bytes) -> bytes:
    """A package with the metadata of another and one tile (section 1 of the format)."""
    root = gzip.compress(b"".join(map(varint, (1, tile_number(*tile), 1, len(content), 1))), mtime=0)
    metadata = gzip.compress(json.dumps(package.metadata).encode(), mtime=0)
    regions, at = [], 127
    for length in (len(root), len(metadata), 0, len(content)):
        regions += [at, length]
        at += length
    header = struct.pack("<7sB11Q", b"PMTiles", 3, *regions, 1, 1, 1)
    header += bytes([1, 2, 1, 0, 0, package.grid.max_level])
    return header.ljust(127, b"\0") + root + metadata + content


class BitWriter:
    """Range-coded bits: the code is the lower end of the range, with as many bytes as the reader takes."""

    def __init__(self) -> None:
        self.low, self.range, self.bytes = 0, 0xFFFF_FFFF, 4

    def _put(self, bound: int, bit: int) -> None:
        self.low, self.range = (self.low + bound, self.range - bound) if bit else (self.low, bound)
        while self.range < 1 << 24:
            self.low, self.range, self.bytes = self.low << 8, self.range << 8, self.bytes + 1

    def even(self, bit: int) -> None:
        self._put(self.range >> 1, bit)

    def bit(self, bit: int, *used: list[int]) -> None:
        """A bit with a model, or with two."""
        p = sum(map(sum, used)) // (2 * len(used))
        self._put((self.range >> 16) * min(max(p, LEAST), LARGEST), bit)
        for model in used:
            learn(model, bit)

    def done(self) -> bytes:
        return self.low.to_bytes(self.bytes, "big")


class NumberWriter:
    """A kind of numbers (section 5 of the format)."""

    def __init__(self, bits: BitWriter, first: int = 1, second: int = 1) -> None:
        self.bits = bits
        self.x, self.y = [models(32) for _ in range(first)], [models(32) for _ in range(second)]
        self.z = [models(4) for _ in range(33)]

    def unsigned(self, number: int, first: int = 0, second: int = 0) -> None:
        x, y = self.x[min(first, len(self.x) - 1)], self.y[min(second, len(self.y) - 1)]
        length = number.bit_length()
        for k in range(min(length + 1, 32)):
            self.bits.bit(k < length, x[k], y[k])
        m = 1
        for place in range(length - 2, -1, -1):
            digit = number >> place & 1
            self.bits.bit(digit, self.z[length][m]) if m < 4 else self.bits.even(digit)
            m = 2 * m + digit

    def write(self, number: int) -> None:
        self.unsigned(abs(number))
        if number:
            self.bits.even(number < 0)


class StepWriter:
    """Steps as in kinds 10 and 11 of the format."""

    def __init__(self, bits: BitWriter) -> None:
        self.bits = bits
        self.along, self.across = NumberWriter(bits, 33, 5), NumberWriter(bits, 100, 33)
        self.g = [models(4) for _ in range(5)]
        self.h = [[models(7), models(7)] for _ in range(5)]

    def write(self, before: Point, step: Point) -> None:
        signs = [-1 if part < 0 else 1 for part in before]
        (long, short), (along, across) = ([part * sign for part, sign in zip(point, signs, strict=True)] for point in (before, step))
        if short > long:
            long, short, along, across = short, long, across, along
        slope = 1 + min(4 * short // long, 3) if long else 0
        lens = [abs(part).bit_length() for part in (long, along, across)]
        self.along.unsigned(abs(along), lens[0], slope)
        self.across.unsigned(abs(across), 5 * min(lens[1], 19) + slope, lens[0])
        if along:
            self.bits.bit(along < 0, self.g[slope][min(max(lens[1] + 2 - lens[0], 0), 3)])
        if across:
            self.bits.bit(across < 0, self.h[slope][along < 0][min(max(lens[2] + 3 - lens[1], 0), 6)])


def ring_bits(rings: list[list[Point]], spacing: int, corner: Point) -> bytes:
    """The points of rings (rules 1 to 4 of layer sections)."""
    bits = BitWriter()
    on, back, same_way, is_beside = models(4)
    e = [models(2) for _ in range(3)]
    numbers_back, starts, beside = NumberWriter(bits), [NumberWriter(bits), NumberWriter(bits)], [NumberWriter(bits), NumberWriter(bits)]
    steps = StepWriter(bits)
    #: The points that were written, each with its ring and its place there.
    points: list[tuple[Point, int, int]] = []
    first_at: dict[Point, int] = {}
    at = (corner[0] // spacing, corner[1] // spacing)
    for number, ring in enumerate(rings):
        before, found, by = (0, 0), 0, (0, 0)
        for i, point in enumerate(ring):
            is_neighbour = False
            # `by` is the number of the point before and its direction, if it occurred before.
            if found and points[by[0]][1] < number:
                _, known, place = points[by[0]]
                size = len(rings[known])
                for way, model in ((by[1], same_way),) if found == 2 else ((1, on), (-1, back)):
                    is_neighbour = rings[known][(place + way) % size] == point
                    bits.bit(is_neighbour, model)
                    if is_neighbour:
                        found, by = 2, (by[0] - place + (place + way) % size, way)
                        break
            to = point[0] // spacing, point[1] // spacing
            step = to[0] - at[0], to[1] - at[1]
            if not is_neighbour:
                bits.bit(point in first_at, e[found][i == 0])
                if point in first_at:
                    numbers_back.unsigned(len(points) - 1 - first_at[point])
                    found, by = 1, (first_at[point], 0)
                else:
                    found = 0
                    if i == 0:
                        for kind, part in zip(starts, step, strict=True):
                            kind.write(part)
                    else:
                        steps.write(before, step)
                    off = point[0] % spacing, point[1] % spacing
                    bits.bit(off != (0, 0), is_beside)
                    if off != (0, 0):
                        for kind, part in zip(beside, off, strict=True):
                            kind.unsigned(part)
            before, at = (step if i else (0, 0)), to
            first_at.setdefault(point, len(points))
            points.append((point, number, i))
    return bits.done()


def point_columns(points: list[Point], spacing: int, corner: Point) -> list[bytes]:
    """Points of lines and points on the coarse lattice."""
    columns = []
    for axis in (0, 1):
        places = [corner[axis] // spacing, *(point[axis] // spacing for point in points)]
        columns.append(planes(signed(to - at) for at, to in zip(places, places[1:], strict=False)))
    return columns
