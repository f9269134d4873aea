#!/usr/bin/env python3
"""Checks decoded tiles of a package independently, with numpy and shapely and without our own geometry code.

Reads `corniche info PACKAGE --json` (key `tiles`) and `corniche tile PACKAGE Z/X/Y --json` and checks that

    orientation  every triangle is counter-clockwise seen from above
    manifold     no directed edge belongs to two triangles
    overlap      the triangles' areas add up to the area of their union, within the tile
    outline      an edge of one triangle only lies on the tile's border or along cell edges (a void's outline);
                 without the latter, the triangles fill the tile
    seam         two tiles of a level have bit-equal vertices (x, y, z) where both have ground at their border
    error        a tile's geometric error is not below its children's
    outside      every GEO edge lies in one triangle, to a micrometre
    off-plane    and on its plane, to max(1 cm, 1 % of max_error_m)
    order        roads are sorted by class
    plan         GEO points lie within 2 mm of the way's SV line
    missing      SV points on the tile's ground lie within 2 mm of the way's GEO line

Prints a summary as JSON; exits 1 when something is violated, 2 when the tiles could not be read.
"""

import argparse
import json
import subprocess
import sys
from collections import Counter

import numpy as np
from shapely.geometry import Point, Polygon
from shapely.ops import unary_union
from shapely.prepared import prep

IN_PLAN_M = 1e-6
NEAR_LINE_M = 0.002
# Areas are sums of thousands of rounded products; relative to the tile's own area.
AREA_SHARE = 1e-9


class Findings:
    """Violations, by kind and in words."""

    def __init__(self):
        self.counts = Counter()
        self.examples = []
        self.checked = Counter()

    def add(self, kind, tile, text):
        """Records a violation."""
        self.counts[kind] += 1
        if self.counts[kind] <= 5:
            self.examples.append(f"{kind}: {tile}: {text}")


class Tile:
    """A tile as `corniche tile --json` prints it."""

    def __init__(self, record):
        self.id = record["id"]
        self.z, self.x, self.y = (int(part) for part in self.id.split("/"))
        self.bounds = [float(v) for v in record["bounds"]]
        # East and north.
        self.cell_m = np.array([float(side) for side in record["cell_m"]])
        self.max_error_m = float(record.get("max_error_m") or 0.0)
        self.error_m = record.get("geometric_error_m")
        tin = record.get("tin") or {"vertices": [], "triangles": []}
        self.vertices = np.array(tin["vertices"], dtype=np.float64).reshape(-1, 3)
        self.triangles = np.array(tin["triangles"], dtype=np.int64).reshape(-1, 3)
        self.geo, self.sv = record["roads_geo"], record["roads_sv"]
        # Positions relative to a corner: differences of large coordinates are exact, their products
        # are not.
        self.local = self.vertices - [self.bounds[0], self.bounds[1], 0.0]

    @property
    def size(self):
        """Width and height in metres."""
        return self.bounds[2] - self.bounds[0], self.bounds[3] - self.bounds[1]


def signed_areas(tile):
    """Area of each triangle, positive when counter-clockwise."""
    a, b, c = (tile.local[tile.triangles[:, k], :2] for k in range(3))
    return 0.5 * ((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]))


def check_tin(tile, found):
    """Checks that triangles cover the tile's ground exactly once. Returns the ground as a polygon and its outline."""
    if len(tile.triangles) == 0:
        return Polygon(), []
    areas = signed_areas(tile)
    for k in np.flatnonzero(areas <= 0.0):
        found.add("orientation", tile.id, f"triangle {k} has area {areas[k]} m²")
    directed = Counter()
    for k in range(3):
        pairs = zip(tile.triangles[:, k].tolist(), tile.triangles[:, (k + 1) % 3].tolist())
        directed.update(pairs)
    for edge, times in directed.items():
        if times > 1:
            found.add("manifold", tile.id, f"edge {edge} belongs to {times} triangles on one side")
    outline = [edge for edge in directed if edge[::-1] not in directed]

    corners = tile.local[tile.triangles][:, :, :2]
    ground = unary_union([Polygon(t) for t, area in zip(corners, areas) if area != 0.0])
    width, height = tile.size
    total, whole = float(np.abs(areas).sum()), width * height
    if abs(total - ground.area) > AREA_SHARE * whole:
        found.add("overlap", tile.id, f"triangles of {total} m² cover {ground.area} m²")
    low, high = tile.local[:, :2].min(axis=0), tile.local[:, :2].max(axis=0)
    if (low < 0.0).any() or high[0] > width or high[1] > height:
        found.add("overlap", tile.id, "vertices lie outside the tile")

    inner = 0
    for i, j in outline:
        a, b = tile.local[i], tile.local[j]
        along = [k for k in (0, 1) if a[k] == b[k]]
        if any(a[k] in (0.0, tile.size[k]) for k in along):
            continue
        inner += 1
        steps = np.array([a[:2], b[:2]]) / tile.cell_m
        if not along or np.abs((steps - np.round(steps)) * tile.cell_m).max() > IN_PLAN_M:
            found.add("outline", tile.id, f"edge {a.tolist()}–{b.tolist()} is open but no border or cell edge")
    if inner == 0 and abs(total - whole) > AREA_SHARE * whole:
        found.add("outline", tile.id, f"no void, yet {total} m² of {whole} m² are covered")
    found.checked["triangles"] += len(tile.triangles)
    return ground, outline


def border(tile, outline, side):
    """Ground along one side (west, east, south, north = 0…3): its segments as sorted pairs of (along, z)."""
    axis, fixed = (0, tile.bounds[0]) if side == 0 else (0, tile.bounds[2]) if side == 1 else (
        (1, tile.bounds[1]) if side == 2 else (1, tile.bounds[3])
    )
    out = []
    for i, j in outline:
        a, b = tile.vertices[i], tile.vertices[j]
        if a[axis] == fixed and b[axis] == fixed:
            ends = sorted([(a[1 - axis], a[2]), (b[1 - axis], b[2])])
            out.append(tuple(ends))
    return sorted(out)


def check_seam(one, other, first, second, found):
    """Checks that both tiles have the same vertices where they have ground along their common border."""

    def runs(segments):
        merged = []
        for (a, _), (b, _) in segments:
            if merged and merged[-1][1] == a:
                merged[-1][1] = b
            else:
                merged.append([a, b])
        return merged

    for a0, a1 in runs(first):
        for b0, b1 in runs(second):
            low, high = max(a0, b0), min(a1, b1)
            if low >= high:
                continue
            sets = [
                {end for segment in segments for end in segment if low <= end[0] <= high}
                for segments in (first, second)
            ]
            found.checked["seam_vertices"] += len(sets[0])
            if sets[0] != sets[1]:
                odd = sorted(sets[0] ^ sets[1])[:3]
                found.add("seam", f"{one.id} | {other.id}", f"{len(sets[0] ^ sets[1])} vertices differ: {odd}")


class Locator:
    """The triangle that contains an edge, by a grid of buckets."""

    BUCKETS = 48

    def __init__(self, tile):
        self.tile = tile
        corners = tile.local[tile.triangles]
        self.corners = corners
        self.step = [max(side, 1e-9) / self.BUCKETS for side in tile.size]
        self.table = {}
        low, high = corners[:, :, :2].min(axis=1), corners[:, :, :2].max(axis=1)
        first = np.floor((low - IN_PLAN_M) / self.step).astype(int)
        last = np.floor((high + IN_PLAN_M) / self.step).astype(int)
        for k, ((c0, r0), (c1, r1)) in enumerate(zip(first.tolist(), last.tolist())):
            for c in range(c0, c1 + 1):
                for r in range(r0, r1 + 1):
                    self.table.setdefault((c, r), []).append(k)

    def gap(self, p, q):
        """(distance outside the best triangle, distance from its plane) for the edge p–q, in metres."""
        middle = 0.5 * (p + q)
        key = tuple(int(np.floor(middle[k] / self.step[k])) for k in (0, 1))
        near = self.table.get(key)
        if not near:
            return np.inf, np.inf
        t = self.corners[near]
        outside = np.zeros(len(near))
        for k in range(3):
            a, b = t[:, k], t[:, (k + 1) % 3]
            d = b[:, :2] - a[:, :2]
            length = np.hypot(d[:, 0], d[:, 1])
            for e in (p, q):
                left = (d[:, 0] * (e[1] - a[:, 1]) - d[:, 1] * (e[0] - a[:, 0])) / length
                outside = np.maximum(outside, -left)
        a, ab, ac = t[:, 0], t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]
        det = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
        off = np.zeros(len(near))
        for e in (p, q):
            x, y = e[0] - a[:, 0], e[1] - a[:, 1]
            u, v = (x * ac[:, 1] - y * ac[:, 0]) / det, (ab[:, 0] * y - ab[:, 1] * x) / det
            off = np.maximum(off, np.abs(a[:, 2] + u * ab[:, 2] + v * ac[:, 2] - e[2]))
        inside = outside <= IN_PLAN_M
        if inside.any():
            return 0.0, float(off[inside].min())
        k = int(outside.argmin())
        return float(outside[k]), float(off[k])


def distances(points, lines):
    """Distance in plan of each point from the nearest of `lines`."""
    best = np.full(len(points), np.inf)
    for line in lines:
        for a, b in zip(line[:-1], line[1:]):
            d = b - a
            square = float(d @ d)
            t = np.clip(((points - a) @ d) / square, 0.0, 1.0) if square > 0 else np.zeros(len(points))
            off = points - (a + t[:, None] * d)
            best = np.minimum(best, np.hypot(off[:, 0], off[:, 1]))
    return best


def by_way(roads, tile):
    """Plan lines of each way, relative to the tile's corner."""
    out = {}
    for road in roads:
        line = np.array(road["line"], dtype=np.float64)[:, :2] - tile.bounds[:2]
        out.setdefault(road["way_id"], []).append(line)
    return out


def check_roads(tile, ground, found):
    """Checks that GEO roads are on the TIN, in order, above their SV lines, and complete."""
    for name, roads in (("roads_geo", tile.geo), ("roads_sv", tile.sv)):
        classes = [road["frc"] for road in roads]
        if classes != sorted(classes):
            found.add("order", tile.id, f"{name} is not sorted by class")
    allowed_m = max(0.01, 0.01 * tile.max_error_m)
    locator = Locator(tile) if len(tile.triangles) else None
    for road in tile.geo:
        line = np.array(road["line"], dtype=np.float64).reshape(-1, 3) - [*tile.bounds[:2], 0.0]
        name = f"way {road['way_id']} part {road['part']}"
        for p, q in zip(line[:-1], line[1:]):
            found.checked["geo_edges"] += 1
            outside, off = locator.gap(p, q) if locator else (np.inf, np.inf)
            found.checked["largest_gap_um"] = max(
                found.checked["largest_gap_um"], int(off * 1e6) if np.isfinite(off) else 0
            )
            if outside > IN_PLAN_M:
                found.add("outside", tile.id, f"{name}: an edge leaves its triangle by {outside} m")
            elif off > allowed_m:
                found.add("off-plane", tile.id, f"{name}: {off} m off the TIN")
    geo, sv = by_way(tile.geo, tile), by_way(tile.sv, tile)
    for way, lines in geo.items():
        off = distances(np.vstack(lines), sv.get(way, []))
        if off.max() > NEAR_LINE_M:
            found.add("plan", tile.id, f"way {way}: GEO is {off.max()} m from its SV line")
    if ground.is_empty:
        return
    # A little smaller, so that points on the very edge of the ground do not count.
    inside = prep(ground.buffer(-0.01))
    for way, lines in sv.items():
        points = np.array([p for p in np.vstack(lines) if inside.contains(Point(p))]).reshape(-1, 2)
        if len(points):
            off = distances(points, geo.get(way, []))
            if off.max() > NEAR_LINE_M:
                found.add("missing", tile.id, f"way {way}: an SV point on the ground is {off.max()} m from GEO")


def check_tiles(tiles):
    """All checks over tiles {(z, x, y): Tile}."""
    found = Findings()
    outlines = {}
    for key, tile in sorted(tiles.items()):
        ground, outlines[key] = check_tin(tile, found)
        check_roads(tile, ground, found)
    for (z, x, y), tile in sorted(tiles.items()):
        for key, mine, theirs in (((z, x + 1, y), 1, 0), ((z, x, y + 1), 2, 3)):
            other = tiles.get(key)
            if other is not None:
                first = border(tile, outlines[tile.z, tile.x, tile.y], mine)
                check_seam(tile, other, first, border(other, outlines[key], theirs), found)
        parent = tiles.get((z - 1, x // 2, y // 2))
        if parent is not None and None not in (parent.error_m, tile.error_m) and tile.error_m > parent.error_m:
            found.add("error", parent.id, f"{parent.error_m} m is below {tile.error_m} m of {tile.id}")
    found.checked["tiles"] = len(tiles)
    return found


def ask(command):
    """The JSON that a command prints."""
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8")
    if done.returncode != 0:
        sys.stderr.write(f"{' '.join(command)} failed: {done.stderr}\n")
        sys.exit(2)
    try:
        return json.loads(done.stdout)
    except json.JSONDecodeError as error:
        sys.stderr.write(f"{' '.join(command)} printed no JSON: {error}\n")
        sys.exit(2)


def wanted_levels(text, listed):
    """The levels in `--levels`: `all`, or numbers and ranges such as 0,2-4."""
    if text == "all":
        return set(listed)
    levels = set()
    for part in text.split(","):
        low, _, high = part.partition("-")
        levels.update(range(int(low), int(high or low) + 1))
    return levels


def main():
    """Reads the arguments, checks, reports."""
    parser = argparse.ArgumentParser(description="Checks the tiles of a package independently.")
    parser.add_argument("package", nargs="?", help="the .pmtiles file")
    parser.add_argument("--corniche", default="corniche", metavar="BIN", help="the program to ask")
    parser.add_argument("--levels", default="all", help="levels to check, such as 0,2-4 [default: all]")
    parser.add_argument("--max-tiles", type=int, metavar="N", help="stop after N tiles, finest first")
    parser.add_argument("--self-test", action="store_true", help="show that broken tiles are caught")
    args = parser.parse_args()
    if args.self_test:
        sys.dont_write_bytecode = True
        import check_tile_selftest

        sys.exit(check_tile_selftest.run())
    if args.package is None:
        parser.error("name a package, or give --self-test")
    listed = [tuple(int(v) for v in name.split("/")) for name in ask([args.corniche, "info", args.package, "--json"])["tiles"]]
    levels = wanted_levels(args.levels, {key[0] for key in listed})
    keys = sorted((key for key in listed if key[0] in levels), key=lambda key: (-key[0], key[1:]))[: args.max_tiles]
    if not keys:
        sys.stderr.write(f"{args.package} has no tiles at levels {args.levels}\n")
        sys.exit(2)
    tiles = {}
    for key in keys:
        name = "/".join(str(v) for v in key)
        tiles[key] = Tile(ask([args.corniche, "tile", args.package, name, "--json"]))
    found = check_tiles(tiles)
    summary = {
        "package": args.package,
        "tiles": len(tiles),
        "tiles_listed": len(listed),
        "checked": dict(sorted(found.checked.items())),
        "violations": dict(sorted(found.counts.items())),
        "examples": found.examples,
    }
    print(json.dumps(summary, indent=1, ensure_ascii=False))
    sys.exit(1 if found.counts else 0)


if __name__ == "__main__":
    main()
