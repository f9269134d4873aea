"""Writes the finest level of a package as a recording for rerun: recording.py CORNICHE PACKAGE FILE.rrd HEIGHT LON LAT DISTANCE HEADING PITCH

One mesh with normals and a colour for each vertex, and lines for the roads, in metres around the place looked at, as somebody would log them. rerun has no levels of detail,
so all of it is read before a picture.
"""

import json
import math
import subprocess
import sys

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

HEIGHTS = [400, 800, 1500, 2200, 3000]
COLOURS = [(169, 193, 143), (195, 207, 159), (216, 211, 171), (203, 185, 153), (236, 232, 226)]
ROADS = [(217, 96, 59), (224, 138, 60), (230, 176, 74), (236, 208, 106), (245, 239, 200), (255, 255, 255), (255, 255, 255), (255, 255, 255), (181, 138, 99)]
ROAD_WIDTHS_PX = [3, 2.5, 2.5, 2, 1.5, 1.5, 1, 1, 1]
# On the ground itself lines would fight with it for depth.
LIFT_M = 10.0

corniche, package, file = sys.argv[1:4]
height_m, lon, lat, distance_m, heading, pitch = (float(text) for text in sys.argv[4:10])


def told(*options):
    return json.loads(subprocess.run([corniche, *options, "--json"], check=True, capture_output=True).stdout)


info = told("info", package)
finest = max(int(one.split("/")[0]) for one in info["tiles"])
ids = [one for one in info["tiles"] if one.startswith(f"{finest}/")]
# The package is in degrees; its metres are those along each axis.
unit = info["manifest"]["metres_per_unit"]
middle = np.array([lon * unit[0], lat * unit[1], 0.0])

vertices, normals, triangles, lines, classes = [], [], [], [], []
count = 0
for one in ids:
    tile = told("tile", package, one)
    ground = tile["tin"]
    vertices.append(np.array(ground["vertices"]) - middle)
    normals.append(np.array(ground["normals"]))
    triangles.append(np.array(ground["triangles"]) + count)
    count += len(ground["vertices"])
    for road in tile["roads_geo"]:
        lines.append((np.array(road["line"]) - middle + [0, 0, LIFT_M]).astype(np.float32))
        classes.append(min(road["frc"], len(ROADS) - 1))
vertices, normals, triangles = (np.concatenate(parts) for parts in (vertices, normals, triangles))
shades = np.stack([np.interp(vertices[:, 2], HEIGHTS, [colour[k] for colour in COLOURS]) for k in range(3)], axis=1).astype(np.uint8)

target = np.array([0.0, 0.0, height_m])
# Its pictures are 55 degrees high, those of the other maps 45; nearer, the ground is as large.
distance_m *= math.tan(math.radians(45 / 2)) / math.tan(math.radians(55 / 2))
flat, turn = math.radians(pitch), math.radians(heading)
eye = target + distance_m * np.array([-math.sin(flat) * math.sin(turn), -math.sin(flat) * math.cos(turn), math.cos(flat)])
view = rrb.Spatial3DView(
    origin="/",
    background=(223, 230, 233),
    line_grid=False,
    eye_controls=rrb.EyeControls3D(kind=rrb.Eye3DKind.Orbital, position=eye, look_target=target, eye_up=(0, 0, 1)),
)
rr.init("liechtenstein")
rr.save(file, default_blueprint=rrb.Blueprint(view, collapse_panels=True))
rr.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
rr.log("ground", rr.Mesh3D(vertex_positions=vertices.astype(np.float32), vertex_normals=normals.astype(np.float32), vertex_colors=shades, triangle_indices=triangles.astype(np.uint32)), static=True)
rr.log("roads", rr.LineStrips3D(lines, colors=[ROADS[k] for k in classes], radii=rr.Radius.ui_points([ROAD_WIDTHS_PX[k] / 2 for k in classes])), static=True)
print(f"{len(ids)} tiles of level {finest}: {len(vertices)} vertices, {len(triangles)} triangles, {len(lines)} lines")
