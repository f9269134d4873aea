"""Decodes terrain tiles with quantized-mesh-tile and checks them: python terrain.py FOLDER…

Decoding, the grid of tiles and the conversion to the earth's axes are that package's, none of it is Corniche's. Each tile is checked by itself, then
against its neighbours, then against layer.json. At the end some tiles are falsified, and each of these faults must be found.
"""

import json
import math
import pathlib
import sys

import numpy
from quantized_mesh_tile.global_geodetic import GlobalGeodetic
from quantized_mesh_tile.llh_ecef import LLH2ECEF
from quantized_mesh_tile.terrain import TerrainTile

LAST = 32767
SIDES = ["west", "south", "east", "north"]
RADII_M = numpy.array([6378137.0, 6378137.0, 6356752.3142451793])
# In double precision, with numbers as large as the earth's radius.
ROUNDING_M = 1e-6
# The codec of normals has 8 bits per axis.
LEAST_LENGTH = 0.99


class Wrong(Exception):
    """A violation in a tile."""


def require(holds, text):
    if not holds:
        raise Wrong(text)


class Tile:
    """A decoded tile as arrays."""

    def __init__(self, path, place):
        z, x, y = place
        decoded = TerrainTile(**dict(zip(SIDES, GlobalGeodetic(True).TileBounds(x, y, z))))
        with open(path, "rb") as file:
            decoded.fromBytesIO(file, hasLighting=True)
            self.rest = len(file.read())
        self.header = dict(decoded.header)
        self.steps = numpy.array([decoded.u, decoded.v, decoded.h])
        self.triangles = numpy.array(decoded.indices).reshape(-1, 3)
        self.edges = dict(zip(SIDES, [decoded.westI, decoded.southI, decoded.eastI, decoded.northI]))
        self.normals = numpy.array(decoded.vLight)
        self.places = decoded.getVerticesCoordinates()
        self.on_earth = numpy.array([LLH2ECEF(*place) for place in self.places])

    def header_point(self, name):
        return numpy.array([self.header[name + axis] for axis in "XYZ"])


def check_vertices(tile):
    require(tile.rest == 0, f"{tile.rest} bytes are left over")
    require(tile.steps.min() >= 0 and tile.steps.max() <= LAST, "u, v or height is outside of 0 to 32767")
    u, v, height = tile.steps
    require(len(set(zip(u, v))) == len(u), "two vertices lie at one place")
    low, high = tile.header["minimumHeight"], tile.header["maximumHeight"]
    require(math.isfinite(low) and math.isfinite(high) and low <= high, f"heights from {low} to {high}")
    require(-12_000 < low and high < 9_000, f"heights from {low} to {high} m are not of this earth")
    if low < high:
        # Both ends are rounded to f32, which on nearly level ground is more than a step.
        rounding = numpy.spacing(numpy.float32(max(abs(low), abs(high))))
        beside = (height.min() + LAST - height.max()) * (high - low) / LAST
        require(beside <= 2 * rounding, "the range of heights is not that of the vertices")


def check_topology(tile):
    """Checks that triangles cover the tile once, each counter-clockwise from above, and that each edge has one on both sides or is on the border."""
    u, v, _ = tile.steps.astype(numpy.int64)
    a, b, c = tile.triangles.T
    require(tile.triangles.min() == 0 and tile.triangles.max() == len(u) - 1, "indices are not those of the vertices")
    require(len(numpy.unique(tile.triangles)) == len(u), "a vertex has no triangle")
    doubled = (u[b] - u[a]) * (v[c] - v[a]) - (u[c] - u[a]) * (v[b] - v[a])
    require((doubled > 0).all(), "a triangle is flat or seen from below")
    require(doubled.sum() == 2 * LAST * LAST, "triangles do not cover the tile once")
    directed = numpy.concatenate([tile.triangles[:, [0, 1]], tile.triangles[:, [1, 2]], tile.triangles[:, [2, 0]]])
    edges = set(map(tuple, directed))
    require(len(edges) == len(directed), "two triangles lie on one side of an edge")
    for one, other in edges:
        if (other, one) not in edges:
            on_border = any(steps[one] == steps[other] == end for steps in (u, v) for end in (0, LAST))
            require(on_border, f"an edge inside of the tile has a triangle on one side only: {one} to {other}")


def border(tile, side):
    """Vertices of a side from its south or west, by their positions, because the list of the side has another order."""
    u, v, _ = tile.steps
    across, along = (u, v) if side in ("west", "east") else (v, u)
    on_side = numpy.flatnonzero(across == (0 if side in ("west", "south") else LAST))
    return on_side[numpy.argsort(along[on_side])], along


def check_edges(tile):
    for side in SIDES:
        on_side, along = border(tile, side)
        require(sorted(tile.edges[side]) == sorted(on_side), f"the list of the {side} side is not that of its vertices")
        ends = along[on_side]
        require(len(ends) >= 2 and ends[0] == 0 and ends[-1] == LAST, f"a corner of the {side} side has no vertex")


def check_globe(tile, is_around_the_globe):
    """Checks that the sphere contains all vertices, that its centre is close to them, and that the horizon hides no visible vertex."""
    middle, radius = tile.header_point("boundingSphereCenter"), tile.header["boundingSphereRadius"]
    distances = numpy.linalg.norm(tile.on_earth - middle, axis=1)
    require(distances.max() <= radius + ROUNDING_M, f"a vertex is {distances.max() - radius} m outside of the sphere")
    require(radius <= 1.01 * distances.max() + 0.01, "the sphere is far too large")
    center = tile.header_point("center")
    low, high = tile.on_earth.min(axis=0) - 0.01, tile.on_earth.max(axis=0) + 0.01
    require(((low <= center) & (center <= high)).all(), "the centre is not among the vertices")
    if is_around_the_globe:
        return
    # In the ellipsoid's radii the globe is a ball of radius 1. A point P stands for the tile when
    # from wherever some vertex V is seen, so is P: from V's tangent cone, that is where P's
    # distance along its direction is at least that of each vertex, cos(angle) cos(b) - sin(angle)
    # sin(b) with cos b = 1/|V|.
    point = tile.header_point("horizonOcclusionPoint")
    reach = numpy.linalg.norm(point)
    require(reach >= 1.0, "the horizon's point lies in the earth")
    scaled = tile.on_earth / RADII_M
    out = numpy.maximum(numpy.linalg.norm(scaled, axis=1), 1.0)
    towards = scaled / numpy.linalg.norm(scaled, axis=1)[:, None]
    cos = towards @ (point / reach)
    sin = numpy.linalg.norm(numpy.cross(towards, point / reach), axis=1)
    needed = cos / out - sin * numpy.sqrt(out**2 - 1) / out
    require((needed * reach >= 1 - 1e-9).all(), "a vertex is seen where the horizon's point is hidden")
    require(reach <= 1.0 / needed.min() + 1e-6, "the horizon's point is too far out")


def check_normals(tile):
    require(len(tile.normals) == len(tile.places), "there is not a normal for each vertex")
    require((numpy.abs(numpy.linalg.norm(tile.normals, axis=1) - 1) < 1 - LEAST_LENGTH).all(), "a normal is not of length 1")
    lon, lat = numpy.radians([place[:2] for place in tile.places]).T
    up = numpy.stack([numpy.cos(lat) * numpy.cos(lon), numpy.cos(lat) * numpy.sin(lon), numpy.sin(lat)], axis=1)
    require(((tile.normals * up).sum(axis=1) > 0).all(), "a normal points downwards")


def check_tile(tile, place):
    check_vertices(tile)
    check_topology(tile)
    check_edges(tile)
    check_globe(tile, place[0] == 0)
    check_normals(tile)


def step_m(tile):
    """The step of heights."""
    return (tile.header["maximumHeight"] - tile.header["minimumHeight"]) / LAST


def check_border(one, other, sides):
    """Checks that vertices of a border are the same, except for the rounding of heights."""
    (own, along), (next_own, next_along) = border(one, sides[0]), border(other, sides[1])
    require(list(along[own]) == list(next_along[next_own]), f"vertices of the {sides[0]} border are not the neighbour's")
    apart = max(abs(one.places[k][2] - other.places[l][2]) for k, l in zip(own, next_own))
    allowed = (step_m(one) + step_m(other)) / 2 + 1e-3
    require(apart <= allowed, f"the {sides[0]} border is {apart} m from the neighbour's, not {allowed}")
    return apart


def told_by(layer):
    """The tiles in layer.json."""
    return {
        (z, x, y)
        for z, blocks in enumerate(layer["available"])
        for block in blocks
        for x in range(block["startX"], block["endX"] + 1)
        for y in range(block["startY"], block["endY"] + 1)
    }


def check_folder(folder):
    layer = json.loads((folder / "layer.json").read_text())
    require(layer["projection"] == "EPSG:4326" and layer["scheme"] == "tms", "this check is for the geographic grid")
    stored = {tuple(int(part) for part in path.relative_to(folder).with_suffix("").parts): path for path in folder.rglob("*.terrain")}
    require(set(stored) == told_by(layer), "the tiles of layer.json are not those of the folder")
    require({(0, 0, 0), (0, 1, 0)} <= set(stored), "a root is missing")
    require(layer["attribution"] != "", "there is no attribution")
    tiles, vertices, borders, apart = {}, 0, 0, 0.0
    for place, path in sorted(stored.items()):
        try:
            tile = tiles[place] = Tile(path, place)
            check_tile(tile, place)
            z, x, y = place
            vertices += len(tile.places)
            for beside, sides in [((z, x - 1, y), ("west", "east")), ((z, x, y - 1), ("south", "north"))]:
                if beside in tiles:
                    apart = max(apart, check_border(tile, tiles[beside], sides))
                    borders += 1
        except Wrong as wrong:
            raise Wrong(f"{path}: {wrong}") from None
        require(z == 0 or (z - 1, x // 2, y // 2) in stored, f"{path} has no parent")
    print(f"quantized-mesh-tile {folder.name}: {len(tiles)} tiles, {vertices} vertices, {borders} borders, {apart:.4f} m apart at most")
    return tiles


def check_that_faults_are_found(tiles):
    """Falsified tiles must be detected, otherwise the counts mean nothing."""
    place = max(tiles, key=lambda place: (place[0], len(tiles[place].places)))
    tile = tiles[place]
    faults = {
        "a moved vertex": lambda: tile.steps[0].__setitem__(tile.edges["west"][0], 1),
        "a turned triangle": lambda: tile.triangles.__setitem__(0, tile.triangles[0][::-1]),
        "a lost triangle": lambda: setattr(tile, "triangles", tile.triangles[1:]),
        "a short list of an edge": lambda: tile.edges["north"].pop(),
        "a small sphere": lambda: tile.header.__setitem__("boundingSphereRadius", tile.header["boundingSphereRadius"] - 1.0),
        "a low horizon": lambda: [tile.header.__setitem__("horizonOcclusionPoint" + axis, tile.header["horizonOcclusionPoint" + axis] * 0.999) for axis in "XYZ"],
        "a normal downwards": lambda: tile.normals.__setitem__(0, -tile.normals[0]),
        "raised ground": lambda: setattr(tile, "on_earth", tile.on_earth * 1.00001),
    }
    kept = {name: value.copy() for name, value in vars(tile).items() if hasattr(value, "copy")}
    for name, falsify in faults.items():
        for key, value in kept.items():
            copy = {side: list(own) for side, own in value.items()} if key == "edges" else value.copy()
            setattr(tile, key, copy)
        falsify()
        try:
            check_tile(tile, place)
        except Wrong:
            continue
        raise Wrong(f"{name} was not found")


def main():
    tiles = {}
    try:
        for folder in sys.argv[1:]:
            tiles = check_folder(pathlib.Path(folder))
        check_that_faults_are_found(tiles)
    except Wrong as wrong:
        print(f"wrong: {wrong}", file=sys.stderr)
        return 1
    return 0 if tiles else 2


sys.exit(main())
