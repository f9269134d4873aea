"""The PMTiles archive (sections 1 and 2 of the format): header, directories, metadata."""

from __future__ import annotations

import gzip
import json
import zlib
from dataclasses import dataclass
from typing import Any, BinaryIO

from .codes import Cursor
from .errors import ContainerError, PayloadError
from .grid import TileName

MIB = 1 << 20


@dataclass(frozen=True)
class Place:
    """The location of a payload in the file."""

    offset: int
    length: int


def tile_number(z: int, x: int, y: int) -> int:
    """The PMTiles id of a tile: level by level, along a Hilbert curve."""
    number, side = 0, 1 << z - 1 if z else 0
    tx, ty = x, y
    while side:
        rx, ry = int(tx & side > 0), int(ty & side > 0)
        number += side * side * ((3 * rx) ^ ry)
        if not ry:
            if rx:
                tx, ty = side - 1 - tx, side - 1 - ty
            tx, ty = ty, tx
        side >>= 1
    return ((1 << 2 * z) - 1) // 3 + number


def tile_of(number: int) -> TileName:
    """The tile z, x, y with this id."""
    z = 0
    while ((1 << 2 * (z + 1)) - 1) // 3 <= number:
        z += 1
    rest = number - ((1 << 2 * z) - 1) // 3
    x = y = 0
    side = 1
    while side < 1 << z:
        rx = rest >> 1 & 1
        ry = (rest ^ rx) & 1
        if not ry:
            if rx:
                x, y = side - 1 - x, side - 1 - y
            x, y = y, x
        x, y = x + side * rx, y + side * ry
        rest >>= 2
        side <<= 1
    return z, x, y


def read_at(file: BinaryIO, offset: int, length: int, what: str) -> bytes:
    """Reads exactly `length` bytes of the file."""
    try:
        file.seek(offset)
        data = file.read(length)
    except (OSError, OverflowError, ValueError) as cause:
        raise ContainerError(f"{what} cannot be read: {cause}") from cause
    if len(data) != length:
        raise ContainerError(f"the file ends before the end of {what}")
    return data


def unzip(data: bytes, limit: int, what: str) -> bytes:
    """The content of a gzip member, whose CRC-32 is checked."""
    try:
        stream = zlib.decompressobj(31)
        content = stream.decompress(data, limit)
    except (zlib.error, gzip.BadGzipFile) as cause:
        raise ContainerError(f"{what} is corrupt: {cause}") from cause
    if not stream.eof or stream.unused_data:
        raise ContainerError(f"{what} is corrupt: not a single gzip member of at most {limit} bytes")
    return content


def parts(file: BinaryIO) -> tuple[dict[str, Any], dict[TileName, Place]]:
    """The metadata, and the locations of all tiles."""
    header = read_at(file, 0, 127, "the header")
    if header[:7] != b"PMTiles" or header[7] != 3:
        raise ContainerError("this is not a PMTiles archive of version 3")
    if (header[97], header[98], header[99]) != (2, 1, 0):
        raise ContainerError("the compressions or the tile type in the header are not those of a Corniche package")
    words = [int.from_bytes(header[at : at + 8], "little") for at in range(8, 80, 8)]
    root, metadata, leaves, tiles, addressed = words[0:2], words[2:4], words[4:6], words[6:8], words[8]
    end = file.seek(0, 2)
    regions: list[tuple[int, int, str]] = [(0, 127, "header")]
    for (start, length), name in ((root, "root directory"), (metadata, "metadata"), (leaves, "leaf directories"), (tiles, "tiles")):
        regions.append((start, length, name))
    regions = sorted(region for region in regions if region[1])
    for (start, length, name), (after, _, other) in zip(regions, regions[1:] + [(end, 0, "end of the file")], strict=True):
        if start + length > after:
            raise ContainerError(f"the {name} and the {other} overlap")
    if metadata[1] > 16 * MIB:
        raise ContainerError("the metadata are larger than 16 MiB")
    found: dict[int, Place] = {}
    _directory(file, root[0], root[1], (leaves, tiles[1]), 1, None, found)
    at = 0
    for number in sorted(found):
        place = found[number]
        if place.offset < at:
            raise ContainerError(f"tile {tile_of(number)} overlaps another")
        at = place.offset + place.length
    if addressed and addressed != len(found):
        raise ContainerError(f"the header states {addressed} tiles, the directories have {len(found)}")
    text = unzip(read_at(file, metadata[0], metadata[1], "the metadata"), 16 * MIB, "the metadata")
    try:
        content = json.loads(text)
    except (ValueError, RecursionError) as cause:
        raise ContainerError(f"the metadata are not JSON, or nested too deep: {cause}") from cause
    return content, {tile_of(n): Place(tiles[0] + p.offset, p.length) for n, p in found.items()}


def _directory(
    file: BinaryIO,
    offset: int,
    length: int,
    ends: tuple[list[int], int],
    depth: int,
    first: int | None,
    found: dict[int, Place],
) -> None:
    """Reads a directory and its leaf directories. `ends` are the region of the leaves and the length of the region of the tiles."""
    what = f"the directory at byte {offset}"
    if length > 4 * MIB or depth > 4:
        raise ContainerError(f"{what} is too large, or nested too deep")
    cursor = Cursor(unzip(read_at(file, offset, length, what), 4 * MIB, what), what)
    try:
        count = cursor.varint()
        if count > 1 << 17 or 4 * count > len(cursor.data):
            raise ContainerError(f"{what} has too many entries")
        columns = [[cursor.varint() for _ in range(count)] for _ in range(4)]
        cursor.end()
    except PayloadError as cause:
        raise ContainerError(str(cause)) from cause
    number, after = 0, 0
    for i, (step, run, size, place) in enumerate(zip(*columns, strict=True)):
        if (i and not step) or run > 1 or not size or (not place and not i):
            raise ContainerError(f"{what} has an invalid entry")
        number += step
        start = place - 1 if place else after
        after = start + size
        if first is not None and i == 0 and number != first:
            raise ContainerError(f"{what} does not begin with the tile that points to it")
        if run:
            if number in found or number >= ((1 << 64) - 1) // 3:
                raise ContainerError(f"{what} names a tile twice, or a level that is too deep")
            # Checked immediately: a few bytes may list millions of tiles that do not exist.
            if after > ends[1]:
                raise ContainerError(f"tile {tile_of(number)} lies outside the tiles")
            found[number] = Place(start, size)
        else:
            if after > ends[0][1]:
                raise ContainerError(f"{what} points beyond the leaf directories")
            _directory(file, ends[0][0] + start, size, ends, depth + 1, number, found)
