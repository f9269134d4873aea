"""A package: its manifest, and its tiles by z, x and y."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

from .attributes import Attributes, read_attributes
from .container import Place, parts, read_at
from .errors import ContainerError, PayloadError, UnknownTile
from .grid import Grid
from .payload import sections
from .roads import Road, read_roads
from .terrain import Terrain, read_terrain


@dataclass(frozen=True)
class Tile:
    """What a tile holds. Sections of kinds that this reader does not decode are in `sections`, decompressed."""

    z: int
    x: int
    y: int
    #: None for a tile without ground.
    terrain: Terrain | None
    roads: list[Road]
    attributes: list[Attributes]
    sections: dict[int, bytes]


class Package:
    """An open package. Close it, or use it in a `with` statement."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self.metadata: dict[str, Any]
        self._places: dict[tuple[int, int, int], Place]
        self.metadata, self._places = parts(file)
        manifest = self.metadata.get("corniche") if isinstance(self.metadata, dict) else None
        if not isinstance(manifest, dict):
            raise ContainerError("the PMTiles archive has no manifest of Corniche")
        if manifest.get("format_version") != 1:
            raise ContainerError(f"the package has version {manifest.get('format_version')} of the format; this reader knows version 1")
        self.manifest: dict[str, Any] = manifest
        self.grid = Grid.of(manifest)
        for z, x, y in self._places:
            if z > self.grid.max_level:
                raise ContainerError(f"tile {z}/{x}/{y} lies below the finest level")

    @classmethod
    def open(cls, path: str | Path) -> Package:
        """Opens a file."""
        try:
            file = open(path, "rb")
        except OSError as cause:
            raise ContainerError(f"cannot open {path}: {cause.strerror}") from cause
        try:
            return cls(file)
        except BaseException:
            file.close()
            raise

    def close(self) -> None:
        """Closes the file."""
        self._file.close()

    def __enter__(self) -> Package:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def tiles(self) -> list[tuple[int, int, int]]:
        """All tiles (z, x, y), in the order of the file."""
        return list(self._places)

    def tile(self, z: int, x: int, y: int) -> Tile:
        """Decodes a tile."""
        place = self._places.get((z, x, y))
        if place is None:
            raise UnknownTile(f"the package has no tile {z}/{x}/{y}")
        found = sections(read_at(self._file, place.offset, place.length, f"tile {z}/{x}/{y}"), (z, x, y))
        terrain = read_terrain(found[1], self.grid, (z, x, y)) if 1 in found else None
        roads: list[Road] = []
        kind = 10 if 10 in found else 2
        if kind in found:
            if terrain is None or {2, 10} <= found.keys():
                raise PayloadError(f"tile {z}/{x}/{y} has GEO roads without ground, or twice")
            roads = read_roads(found[kind], kind == 10, terrain, self.grid, (z, x, y))
        attributes = read_attributes(found[4], f"attributes of tile {z}/{x}/{y}") if 4 in found else []
        return Tile(z, x, y, terrain, roads, attributes, found)
