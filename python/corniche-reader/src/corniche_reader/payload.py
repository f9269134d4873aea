"""The payload of a tile (section 3 of the format): its section table, with all checksums."""

from __future__ import annotations

import struct
import zlib

import zstandard

from .errors import PayloadError
from .grid import TileName

LARGEST = 64 << 20


def sections(data: bytes, tile: TileName) -> dict[int, bytes]:
    """The decompressed sections, by kind."""
    what = "tile {}/{}/{}".format(*tile)
    if len(data) < 20 or data[:4] != b"CRNT":
        raise PayloadError(f"{what}: not the payload of a tile")
    version, count, z, x, y = struct.unpack_from("<HBBII", data, 4)
    if version != 2:
        raise PayloadError(f"{what} has version {version} of the format, and this reader knows version 2")
    at = 16 + 20 * count
    if len(data) < at + 4 or zlib.crc32(data[:at]) != int.from_bytes(data[at : at + 4], "little"):
        raise PayloadError(f"{what}: the section table is corrupt (CRC-32)")
    if (z, x, y) != tile:
        raise PayloadError(f"{what}: the payload belongs to tile {z}/{x}/{y}")
    found: dict[int, bytes] = {}
    at += 4
    for i in range(count):
        kind, compression, zero, offset, stored, raw, crc = struct.unpack_from("<HBBIIII", data, 16 + 20 * i)
        name = f"{what}, section of kind {kind}"
        if offset != at or offset + stored > len(data) or zero or kind in found or max(stored, raw) > LARGEST:
            raise PayloadError(f"{name}: its entry in the section table is invalid")
        at += stored
        content = data[offset:at]
        if zlib.crc32(content) != crc:
            raise PayloadError(f"{name} is corrupt (CRC-32)")
        found[kind] = _content(content, compression, raw, name)
    if at != len(data):
        raise PayloadError(f"{what} has {len(data) - at} bytes after its sections")
    return found


def _content(stored: bytes, compression: int, raw: int, name: str) -> bytes:
    if compression == 0:
        content = stored
    elif compression == 1:
        try:
            content = zstandard.ZstdDecompressor().decompress(stored, max_output_size=raw)
        except zstandard.ZstdError as cause:
            raise PayloadError(f"{name} is corrupt: {cause}") from cause
    else:
        raise PayloadError(f"{name} has the unknown compression {compression}")
    if len(content) != raw:
        raise PayloadError(f"{name} has {len(content)} bytes, not {raw}")
    return content
