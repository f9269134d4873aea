#!/usr/bin/python3
"""Makes the synthetic pass: pass-dem.tif, pass.osm.pbf and truth.json, beside this file.

Nothing here is a real place. Needs numpy, GDAL's Python binding and osmium-tool (Debian: python3-numpy,
python3-gdal, osmium-tool). The heights and the OSM objects are the same everywhere; the *bytes* of the two
containers depend on the versions of GDAL and osmium, so truth.json also names a hash of their content.

    ./generate.py            write the three files
    ./generate.py --check    compare the content of the files here with what would be written
"""

import hashlib
import json
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from xml.sax.saxutils import quoteattr

# Nothing is left beside the sources.
sys.dont_write_bytecode = True

import numpy as np
from osgeo import gdal, osr

import landforms
import roads
import terrain
from lonlat import from_utm
from network import length_of

HERE = Path(__file__).resolve().parent
DEM, OSM, TRUTH = HERE / "pass-dem.tif", HERE / "pass.osm.pbf", HERE / "truth.json"
# UTM zone 32N, position of the raster's north-west corner.
EPSG, WEST_M, NORTH_M = 32632, 534000.0, 5200000.0
FILL_CELLS = 32
FIRST_NODE, FIRST_WAY = 1001, 101
CREATION = ["COMPRESS=DEFLATE", "PREDICTOR=3", "ZLEVEL=9", "TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256"]


def heights():
    """Heights with voids and without, the lake, and the two voids."""
    z = terrain.fine_heights(terrain.range_heights())
    z = landforms.cut_gorge(terrain.valley_floor(terrain.scree(z, 40)))
    z, lake = landforms.fill_lake(terrain.scree(z, 3))
    holed, small, large = landforms.punch_voids(z)
    return landforms.quantise(holed), landforms.quantise(z), lake, small, large


def write_dem(path, z):
    """GeoTIFF, Float32 in whole sixteenths of a metre, nodata -9999."""
    gdal.UseExceptions()
    raster = gdal.GetDriverByName("GTiff").Create(str(path), *z.shape[::-1], 1, gdal.GDT_Float32, CREATION)
    crs = osr.SpatialReference()
    crs.ImportFromEPSG(EPSG)
    raster.SetProjection(crs.ExportToWkt())
    raster.SetGeoTransform((WEST_M, terrain.CELL_M, 0.0, NORTH_M, 0.0, -terrain.CELL_M))
    band = raster.GetRasterBand(1)
    band.SetNoDataValue(terrain.NODATA)
    band.SetUnitType("m")
    band.WriteArray(z)
    del band, raster


def osm_objects(lines):
    """Nodes {id: (lon, lat) in 1e-7 degrees} and ways [(id, refs, tags)]; one node for each position."""
    nodes, ways, ids = {}, [], {}
    for tags, points in lines:
        refs = []
        for x, y in points:
            lon, lat = from_utm(WEST_M + x, NORTH_M - y)
            at = (round(lon * 1e7), round(lat * 1e7))
            if at not in ids:
                ids[at] = FIRST_NODE + len(ids)
                nodes[ids[at]] = at
            if not refs or refs[-1] != ids[at]:
                refs.append(ids[at])
        ways.append((FIRST_WAY + len(ways), refs, tags | {"source": "synthetic"}))
    return nodes, ways


def osm_text(nodes, ways):
    """The objects as OSM XML, sorted, without dates."""

    def degrees(value):
        return f"{value // 10**7}.{value % 10**7:07d}"

    out = ['<?xml version="1.0" encoding="UTF-8"?>', '<osm version="0.6" generator="corniche-sample">']
    for node, (lon, lat) in sorted(nodes.items()):
        out.append(f'<node id="{node}" lat="{degrees(lat)}" lon="{degrees(lon)}"/>')
    for way, refs, tags in ways:
        out.append(f'<way id="{way}">')
        out += [f'<nd ref="{ref}"/>' for ref in refs]
        out += [f"<tag k={quoteattr(k)} v={quoteattr(v)}/>" for k, v in sorted(tags.items())]
        out.append("</way>")
    return "\n".join([*out, "</osm>", ""])


def write_osm(path, text):
    """`text` as .osm.pbf."""
    with tempfile.NamedTemporaryFile("w", suffix=".osm", encoding="utf-8") as source:
        source.write(text)
        source.flush()
        subprocess.run(
            ["osmium", "cat", "--no-progress", "--overwrite", "--generator=corniche-sample",
             "-f", "pbf,add_metadata=false,pbf_compression=zlib", "-o", str(path), source.name],
            check=True,
        )  # fmt: skip


def filled(void):
    """Which void cells have data within `FILL_CELLS` in each of the eight directions."""
    out = void.copy()
    for dr, dc in ((0, 1), (1, 0), (1, 1), (1, -1)):
        for sign in (1, -1):
            found = np.zeros_like(void)
            for k in range(1, FILL_CELLS + 1):
                r, c = sign * dr * k, sign * dc * k
                # The voids lie far inside, so that wrapping round never reaches them.
                found |= ~np.roll(void, (-r, -c), axis=(0, 1))
            out &= found
    return out


def void_record(mask, both):
    """Extent of a void in cells and metres, and how much of it the default rule fills."""
    rows, cols = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    r0, r1, c0, c1 = (int(v) for v in (rows[0], rows[-1] + 1, cols[0], cols[-1] + 1))
    return {
        "cells": int(mask.sum()),
        "rows": [r0, r1],
        "columns": [c0, c1],
        "bounds_m": [WEST_M + 10.0 * c0, NORTH_M - 10.0 * r1, WEST_M + 10.0 * c1, NORTH_M - 10.0 * r0],
        "filled_at_32_cells": int((filled(both) & mask).sum()),
    }


def truth(z, lake, small, large, nodes, ways, lines):
    """What tests may rely on."""
    kinds, metres, points = Counter(), Counter(), Counter()
    for (tags, line), (_, refs, _) in zip(lines, ways):
        kinds[tags["highway"]] += 1
        metres[tags["highway"]] += length_of(line)
        points[tags["highway"]] += len(refs)
    rows, cols = np.nonzero(lake)
    r, c = int(landforms.LAKE_AXIS[12, 1] // 10), int(landforms.LAKE_AXIS[12, 0] // 10)
    x, y = WEST_M + (c + 0.5) * 10.0, NORTH_M - (r + 0.5) * 10.0
    data = z != terrain.NODATA
    xy = np.array(list(nodes.values())) / 1e7
    return {
        "comment": "Synthetic. Lengths are plan lengths in EPSG:32632, before rounding to 1e-7 degrees; counts are of OSM objects.",
        "dem": {
            "epsg": EPSG, "columns": terrain.SIDE, "rows": terrain.SIDE, "cell_m": terrain.CELL_M,
            "pixel_is": "area", "corner_m": [WEST_M, NORTH_M], "nodata": terrain.NODATA,
            "data_cells": int(data.sum()), "min_m": float(z[data].min()), "max_m": float(z[data].max()),
            "samples_sha256": hashlib.sha256(z.astype("<f4").tobytes()).hexdigest(),
        },
        "lake": {
            "height_m": float(landforms.LAKE_LEVEL_M), "cells": int(lake.sum()),
            "columns": [int(cols.min()), int(cols.max()) + 1], "rows": [int(rows.min()), int(rows.max()) + 1],
            "inside_m": [x, y], "inside_lonlat": [round(v, 7) for v in from_utm(x, y)],
        },
        "voids": {"small": void_record(small, small | large), "large": void_record(large, small | large)},
        "osm": {
            "nodes": len(nodes), "ways": len(ways), "way_nodes": sum(len(refs) for _, refs, _ in ways),
            "bounds_lonlat": [*xy.min(axis=0).tolist(), *xy.max(axis=0).tolist()],
            "content_sha256": hashlib.sha256(osm_text(nodes, ways).encode()).hexdigest(),
            "ways_per_highway": dict(sorted(kinds.items())),
            "way_nodes_per_highway": dict(sorted(points.items())),
            "length_m_per_highway": {k: round(v, 3) for k, v in sorted(metres.items())},
            "bridge_ways": [way for way, _, tags in ways if "bridge" in tags],
            "tunnel_ways": [way for way, _, tags in ways if "tunnel" in tags],
            "gorge_bridge_way": next(way for way, _, tags in ways if tags.get("name") == "Klammbruecke"),
            "roundabout_way": next(way for way, _, tags in ways if tags.get("junction") == "roundabout"),
            "oneway_ways": [way for way, _, tags in ways if "oneway" in tags],
            "ways_into_large_void": [
                way for way, refs, _ in ways if any(_in_void(nodes[ref], large) for ref in refs)
            ],
        },
    }  # fmt: skip


def _in_void(at, void):
    """Whether a node lies on a void cell, by the inverse of its own position."""
    lon, lat = at[0] / 1e7, at[1] / 1e7
    x, y = _UTM.TransformPoint(lon, lat)[:2]
    col, row = int((x - WEST_M) // 10.0), int((NORTH_M - y) // 10.0)
    return 0 <= row < void.shape[0] and 0 <= col < void.shape[1] and bool(void[row, col])


def _utm():
    source, target = osr.SpatialReference(), osr.SpatialReference()
    source.ImportFromEPSG(4326)
    target.ImportFromEPSG(EPSG)
    for crs in (source, target):
        crs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return osr.CoordinateTransformation(source, target)


_UTM = _utm()


def check(z, text):
    """Whether the files here hold what would be written; says what differs."""
    wrong = []
    if not np.array_equal(gdal.Open(str(DEM)).ReadAsArray(), z):
        wrong.append(f"{DEM.name}: heights differ")
    with tempfile.TemporaryDirectory() as folder:
        again = Path(folder, "again.osm.pbf")
        write_osm(again, text)
        dumps = [
            subprocess.run(["osmium", "cat", "--no-progress", "-f", "opl", str(p)], check=True, capture_output=True)
            for p in (OSM, again)
        ]
    if dumps[0].stdout != dumps[1].stdout:
        wrong.append(f"{OSM.name}: objects differ")
    return wrong


def main():
    """Writes or checks the three files."""
    z, whole, lake, small, large = heights()
    lines = roads.build(whole.astype(np.float64), lake).roads
    nodes, ways = osm_objects(lines)
    text = osm_text(nodes, ways)
    facts = json.dumps(truth(z, lake, small, large, nodes, ways, lines), indent=1) + "\n"
    if sys.argv[1:] == ["--check"]:
        wrong = check(z, text)
        if TRUTH.read_text(encoding="utf-8") != facts:
            wrong.append(f"{TRUTH.name}: differs")
        sys.exit("\n".join(wrong) if wrong else 0)
    if sys.argv[1:]:
        sys.exit(__doc__)
    write_dem(DEM, z)
    write_osm(OSM, text)
    TRUTH.write_text(facts, encoding="utf-8")
    for path in (DEM, OSM, TRUTH):
        print(path.name, path.stat().st_size, hashlib.sha256(path.read_bytes()).hexdigest())


if __name__ == "__main__":
    main()
