"""What ice, one stream and the sensor left: the lake, the gorge and the voids of the made-up pass."""

import numpy as np

from noise import catmull_rom, fbm, nearest_on_line, smoothstep
from terrain import CELL_M, NODATA, SIDE, centres

LAKE_LEVEL_M = 1541.5
# Down the middle of the lake, in x and y.
LAKE_AXIS = catmull_rom([(7530, 6080), (7450, 6300), (7390, 6600), (7420, 6900)], 8)
MORAINE = catmull_rom([(7330, 5990), (7480, 5930), (7640, 5960), (7790, 6060)], 6)
# The stream in the gorge: x, y, height of its bed.
GORGE = catmull_rom(
    [
        (8100, 2280, 968),
        (8215, 2560, 986),
        (8190, 2850, 1012),
        (8330, 3150, 1046),
        (8380, 3480, 1084),
        (8490, 3780, 1128),
        (8600, 4080, 1172),
        (8740, 4380, 1214),
    ],
    8,
)
# Centre x and y, half axes, all in metres, of the two patches without data.
SMALL_VOID = (3080, 3300, 75, 105)
LARGE_VOID = (5900, 4350, 460, 520)


def cut_gorge(z):
    """A hanging valley's step: its floor raised to a shoulder, then sawn through to the main valley."""
    x, y = centres(SIDE)
    d, at = nearest_on_line(x, y, GORGE)
    bed = at[..., 0]
    along = np.clip(y, 2280.0, 4400.0)
    shoulder = 1122.0 + (along - 2500.0) * 0.052 + 0.10 * d + 4.0 * fbm(x / 160, y / 160, 3, 131)
    # The shoulder ends above the main valley in a steep brow.
    shoulder = shoulder - 170.0 * (1.0 - smoothstep(2350.0, 2660.0, y)) - 1000.0 * (y < 2240)
    near = 1.0 - smoothstep(500.0, 900.0, d)
    raised = z + np.maximum(shoulder - z, 0.0) * near * (1.0 - smoothstep(4150.0, 4450.0, y))
    half = 14.0 + 6.0 * fbm(x / 110, y / 110, 2, 141)
    wall = bed + np.maximum(d - half, 0.0) * (2.6 + 0.8 * fbm(x / 70, y / 70, 2, 151))
    sawn = np.where(d < 160.0, np.minimum(raised, wall), raised)
    return sawn


def fill_lake(z):
    """A basin dug by ice behind a moraine, and the flat water in it. Returns heights and the lake's mask."""
    x, y = centres(SIDE)
    d, _ = nearest_on_line(x, y, np.column_stack([LAKE_AXIS, np.zeros(len(LAKE_AXIS))]))
    shore = 130.0 + 45.0 * fbm(x / 300, y / 300, 3, 161)
    basin = LAKE_LEVEL_M - 6.0 + (d - shore) * np.where(d > shore, 0.62, 0.1)
    z = np.minimum(z, np.maximum(basin, LAKE_LEVEL_M - 20.0))
    m, _ = nearest_on_line(x, y, np.column_stack([MORAINE, np.zeros(len(MORAINE))]))
    crest = LAKE_LEVEL_M + 9.0 + 5.0 * fbm(x / 120, y / 120, 2, 171) - 0.42 * np.maximum(m - 25.0, 0.0)
    z = np.where(m < 220.0, np.maximum(z, crest), z)
    # The outlet runs over the moraine just above the water.
    notch = np.abs(x - 7560.0) + 0.0 * y
    through = (notch < 25.0) & (m < 160.0) & (y < 6040.0)
    z = np.where(through, np.minimum(z, LAKE_LEVEL_M + 0.5 + 0.3 * np.minimum(notch, 25.0) / 25.0), z)
    low = z < LAKE_LEVEL_M
    row, col = int(LAKE_AXIS[12, 1] / CELL_M), int(LAKE_AXIS[12, 0] / CELL_M)
    lake = np.zeros_like(low)
    lake[row, col] = True
    low &= (d < 700.0) & (y > 5950.0)
    while True:
        grown = lake.copy()
        grown[1:] |= lake[:-1]
        grown[:-1] |= lake[1:]
        grown[:, 1:] |= lake[:, :-1]
        grown[:, :-1] |= lake[:, 1:]
        grown &= low
        if (grown == lake).all():
            return np.where(lake, LAKE_LEVEL_M, z), lake
        lake = grown


def void_mask(void, salt):
    """An irregular patch with the given centre and half axes."""
    x, y = centres(SIDE)
    cx, cy, a, b = void
    u, v = (x - cx) / a, (y - cy) / b
    return u * u + v * v < 0.75 + 0.3 * fbm(x / (0.5 * a), y / (0.5 * b), 3, salt)


def punch_voids(z):
    """Heights with both voids; the masks too."""
    small, large = void_mask(SMALL_VOID, 181), void_mask(LARGE_VOID, 191)
    return np.where(small | large, NODATA, z), small, large


def quantise(z):
    """Heights in whole sixteenths of a metre: exact in float32, and small when compressed."""
    return np.where(z == NODATA, NODATA, np.floor(z * 16.0 + 0.5) / 16.0).astype(np.float32)
