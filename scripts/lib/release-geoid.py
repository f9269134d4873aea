"""Writes the geoid EGM2008, 2.5 minutes, as a grid for PROJ: whole centimetres, from -180 to 180 degrees.

The model itself is off by decimetres, and half a centimetre of rounding makes the file a sixth of its size.

usage: release-geoid.py EGM2008_geoid_h.nc us_nga_egm08_25.tif
"""

import sys

import numpy
import rasterio
from rasterio.transform import Affine

STEP_M = 0.01
# Known undulations at nodes of the grid (NGA's test points; tide-free), as latitude, longitude,
# metres.
KNOWN = [(37.0, 241.0, -26.151), (90.0, 0.0, 14.899), (-90.0, 0.0, -30.150)]
ROWS, COLUMNS = 4321, 8640

source, target = sys.argv[1:]
with rasterio.open(f"netcdf:{source}:geoid_h") as file:
    heights = file.read(1)
if heights.shape != (ROWS, COLUMNS + 1):
    sys.exit(f"{source} has {heights.shape} nodes, not {ROWS} x {COLUMNS + 1}")
for lat, lon, known_m in KNOWN:
    found_m = float(heights[round((90 - lat) * 24), round(lon * 24)])
    if abs(found_m - known_m) > 0.001:
        sys.exit(f"the geoid at {lat}, {lon} is {found_m} m, and should be {known_m} m")
# The source begins at Greenwich, and its last column repeats the first one.
heights = numpy.roll(heights[:, :COLUMNS], COLUMNS // 2, axis=1)
steps = numpy.rint(heights / STEP_M).astype("int16")
form = dict(driver="GTiff", width=COLUMNS, height=ROWS, count=1, dtype="int16", crs="EPSG:4326", tiled=True)
form.update(blockxsize=256, blockysize=256, compress="deflate", predictor=2, zlevel=9)
# A pixel is the area around its node.
form["transform"] = Affine(1 / 24, 0, -180 - 1 / 48, 0, -1 / 24, 90 + 1 / 48)
with rasterio.open(target, "w", **form) as file:
    file.update_tags(AREA_OR_POINT="Point", TYPE="VERTICAL_OFFSET_GEOGRAPHIC_TO_VERTICAL", target_crs_epsg_code="3855")
    file.set_band_description(1, "geoid_undulation")
    file.units = ("metre",)
    file.scales = (STEP_M,)
    file.offsets = (0.0,)
    file.write(steps, 1)
