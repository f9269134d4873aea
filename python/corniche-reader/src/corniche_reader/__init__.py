"""Reads Corniche packages: tiles of TIN terrain with draped roads. Written from `crates/tileset/FORMAT.md` alone."""

from .attributes import Attributes
from .errors import ContainerError, PayloadError, ReadError, UnknownTile
from .layers import LayerObject
from .package import Package, Tile
from .roads import CROSSING, SOURCE, TIN_VERTEX, Road
from .spans import Span
from .terrain import Terrain

__all__ = [
    "CROSSING",
    "SOURCE",
    "TIN_VERTEX",
    "Attributes",
    "ContainerError",
    "LayerObject",
    "Package",
    "PayloadError",
    "ReadError",
    "Road",
    "Span",
    "Terrain",
    "Tile",
    "UnknownTile",
]
