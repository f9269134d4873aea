"""A Corniche package: its manifest, and its tiles by z, x and y."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .attributes import Attributes, read_attributes
from .container import Place, parts, read_at
from .coordinates import Coordinates
from .errors import ContainerError, PayloadError, UnknownTile
from .grid import Grid, TileName
from .height import Ground, tiles_at
from .layers import FIRST_KIND, LayerObject, layer_tables, read_layer
from .payload import sections
from .roads import Road, read_roads
from .spans import Span, read_spans
from .terrain import Terrain, read_terrain

#: The number of tiles whose triangles stay in memory for the next height query.
KEPT_TILES = 32


@dataclass(frozen=True)
class Tile:
    """The content of a tile. Sections of kinds that this reader does not decode are in `sections`, decompressed."""

    z: int
    x: int
    y: int
    #: None for a tile without ground.
    terrain: Terrain | None
    roads: list[Road]
    attributes: list[Attributes]
    # : Runs of bridges and tunnels off the ground, which replace the stretches of the same ways'
    # roads on the ground.
    spans: list[Span]
    #: The objects of each layer of the package, from the lowest layer to the highest, by id of the layer.
    layers: dict[str, list[LayerObject]]
    sections: dict[int, bytes]

    def fields(self, road: Road) -> dict[str, Any]:
        """The fields of a part of a way in `corniche export roads --pieces`, under the same names, except those measured along the line."""
        of_way = next((way for way in self.attributes if way.way_id == road.way_id), None)
        if of_way is None:
            raise PayloadError(f"tile {self.z}/{self.x}/{self.y} has way {road.way_id}, but not its attributes")
        fields = asdict(of_way)
        way_id = fields.pop("way_id")
        return {"way_id": way_id, "class": road.road_class, **fields, "tile": f"{self.z}/{self.x}/{self.y}", "part": road.part}


class Package:
    """An open package. Close it, or use it in a `with` statement."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self.metadata: dict[str, Any]
        self._places: dict[TileName, Place]
        self.metadata, self._places = parts(file)
        manifest = self.metadata.get("corniche") if isinstance(self.metadata, dict) else None
        if not isinstance(manifest, dict):
            raise ContainerError("the PMTiles archive has no Corniche manifest")
        if manifest.get("format_version") != 2:
            raise ContainerError(f"the package has version {manifest.get('format_version')} of the format; this reader knows version 2")
        self.manifest: dict[str, Any] = manifest
        self.grid = Grid.of(manifest)
        self._coordinates = Coordinates(manifest)
        self._layers = dict(enumerate(layer_tables(manifest), FIRST_KIND))
        self._grounds: OrderedDict[TileName, Ground | None] = OrderedDict()
        for z, x, y in self._places:
            if z > self.grid.max_level:
                raise ContainerError(f"tile {z}/{x}/{y} lies below the finest level")

    @classmethod
    def open(cls, path: str | Path) -> Package:
        """Opens a package file."""
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

    def tiles(self) -> list[TileName]:
        """All tiles (z, x, y), in file order."""
        return list(self._places)

    def tile(self, z: int, x: int, y: int) -> Tile:
        """Decodes a tile."""
        found = self._sections((z, x, y))
        terrain = self._terrain((z, x, y), found)
        what = f"tile {z}/{x}/{y}"
        kinds = found.keys() & {2, 10, 13, *(kind for kind, table in self._layers.items() if table.geometry != "area")}
        ground = Ground.of(terrain, self.grid, (z, x, y)) if kinds and terrain is not None else None
        roads, spans = self._on_ground((z, x, y), found, ground, what)
        layers = {
            table.id: read_layer(found[kind], table, ground, self.grid, (z, x, y)) if kind in found else [] for kind, table in self._layers.items()
        }
        if 5 in found and 4 not in found:
            raise PayloadError(f"{what} has tags without attributes")
        attributes = read_attributes(found[4], f"attributes of {what}", found.get(5), f"tags of {what}") if 4 in found else []
        return Tile(z, x, y, terrain, roads, attributes, spans, layers, found)

    def _on_ground(self, name: TileName, found: dict[int, bytes], ground: Ground | None, what: str) -> tuple[list[Road], list[Span]]:
        """Decodes the sections that refer to the triangles: GEO roads and spans."""
        kinds = {2, 10, 13} & found.keys()
        if not kinds:
            return [], []
        if ground is None or {2, 10} <= kinds:
            raise PayloadError(f"{what} has GEO roads or spans without ground, or GEO roads twice")
        roads = [road for kind in sorted(kinds - {13}) for road in read_roads(found[kind], kind == 10, ground, self.grid, name)]
        return roads, read_spans(found[13], ground, self.grid, name, list(self._layers.values())) if 13 in kinds else []

    def _sections(self, name: TileName) -> dict[int, bytes]:
        place, what = self._places.get(name), "tile {}/{}/{}".format(*name)
        if place is None:
            raise UnknownTile(f"the package has no {what}")
        return sections(read_at(self._file, place.offset, place.length, what), name)

    def _terrain(self, name: TileName, found: dict[int, bytes]) -> Terrain | None:
        return read_terrain(found[1], self.grid, name) if 1 in found else None

    def degrees(self, positions: ArrayLike) -> NDArray[np.float64]:
        """The WGS84 [longitude, latitude] of each [x, y, …], such as the vertices of a road or the positions of the ground, to a centimetre."""
        return self._coordinates.degrees(positions)

    def height_at(self, lon: float, lat: float, level: int | None = None) -> float | None:
        """The height of the ground in metres at a WGS84 position in degrees, on the finest or the given level; None where there is no ground."""
        level = self.grid.max_level if level is None else level
        if not 0 <= level <= self.grid.max_level:
            raise UnknownTile(f"the package has no level {level}; its finest is {self.grid.max_level}")
        place = self._coordinates.working(lon, lat)
        if place is None:
            return None
        point = self.grid.snap(*place)
        heights = (self._height_in(name, point) for name in tiles_at(self.grid, level, point))
        return next((height for height in heights if height is not None), None)

    def _height_in(self, name: TileName, point: tuple[int, int]) -> float | None:
        if name not in self._grounds:
            terrain = self._terrain(name, self._sections(name)) if name in self._places else None
            self._grounds[name] = None if terrain is None else Ground.of(terrain, self.grid, name)
            if len(self._grounds) > KEPT_TILES:
                self._grounds.popitem(last=False)
        self._grounds.move_to_end(name)
        ground = self._grounds[name]
        return None if ground is None else ground.height_m(point)
