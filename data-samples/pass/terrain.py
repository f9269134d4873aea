"""Heights of the made-up pass: a river-cut range, then its lake, its gorge, its scree and its voids.

Positions are metres east (x) and south (y) of the north-west corner of the raster.
"""

import heapq
import math

import numpy as np

from noise import (
    box_blur,
    catmull_rom,
    fbm,
    nearest_on_line,
    ridged,
    sample_cubic,
    smoothstep,
    value_noise,
)

SIDE = 1000
CELL_M = 10.0
EXTENT_M = SIDE * CELL_M
NODATA = -9999.0

# The main valley runs along the north and leaves in the west: x, y, height of the floor, half
# width.
MAIN_VALLEY = catmull_rom(
    [
        (10400, 2150, 968, 330),
        (8700, 1720, 958, 380),
        (7000, 1950, 948, 300),
        (5200, 1500, 936, 430),
        (3400, 1820, 924, 480),
        (1600, 1380, 912, 360),
        (-400, 1600, 900, 400),
    ],
    12,
)
# The southern valley leaves in the east, the western one in the south-west.
SOUTH_OUTLET = ((9990, 7450), 1390.0)
WEST_OUTLET = ((10, 7700), 1330.0)
# Where less uplift makes the saddle.
PASS_XY = (7500, 7000)


def centres(side):
    """x and y of the cell centres of a `side` × `side` raster over the whole extent."""
    step = EXTENT_M / side
    axis = (np.arange(side) + 0.5) * step
    return np.meshgrid(axis, axis)


def flood_order(z, fixed):
    """Every cell's receiver and the order downstream-first (priority flood, Barnes et al. 2014).

    Pits drain over their lowest rim, so that no cell is left without a way to a fixed one.
    """
    side = z.shape[0]
    flat = z.ravel().tolist()
    receiver = [-1] * len(flat)
    order, heap = [], []
    for cell in np.flatnonzero(fixed.ravel()).tolist():
        receiver[cell] = cell
        heap.append((flat[cell], cell))
    heapq.heapify(heap)
    while heap:
        level, cell = heapq.heappop(heap)
        order.append(cell)
        r, c = divmod(cell, side)
        for dr in (-1, 0, 1):
            rr = r + dr
            if not 0 <= rr < side:
                continue
            for dc in (-1, 0, 1):
                cc = c + dc
                if not 0 <= cc < side:
                    continue
                other = rr * side + cc
                if receiver[other] < 0:
                    receiver[other] = cell
                    h = flat[other]
                    heapq.heappush(heap, (h if h > level else level, other))
    return receiver, order


def erode(z, fixed, uplift, steepest, erodibility, steps, dt):
    """Stream-power erosion with uplift, implicit in time (Braun & Willett 2013), m = 1/2, n = 1.

    `steepest` caps the slope towards the receiver: landslides hold a hillside at its angle of repose.
    """
    side = z.shape[0]
    dx = EXTENT_M / side
    diagonal = dx * math.sqrt(2.0)
    up, cap, keep = (uplift * dt).ravel().tolist(), steepest.ravel().tolist(), fixed.ravel().tolist()
    strength = (erodibility * dt).ravel().tolist()
    for _ in range(steps):
        receiver, order = flood_order(z, fixed)
        area = [dx * dx] * len(order)
        for cell in reversed(order):
            if receiver[cell] != cell:
                area[receiver[cell]] += area[cell]
        flat = z.ravel().tolist()
        for cell in order:
            if keep[cell]:
                continue
            to = receiver[cell]
            d = dx if abs(cell - to) in (1, side) else diagonal
            f = strength[cell] * math.sqrt(area[cell]) / d
            h = (flat[cell] + up[cell] + f * flat[to]) / (1.0 + f)
            highest = flat[to] + cap[cell] * d
            flat[cell] = highest if h > highest else h
        z = np.array(flat).reshape(side, side)
    return z


def range_heights():
    """The eroded range at 25 m, grown at 100 m, 50 m, 25 m."""
    z = None
    for side, steps, dt in ((100, 90, 30.0), (200, 35, 20.0), (400, 8, 10.0)):
        x, y = centres(side)
        d, at = nearest_on_line(x, y, MAIN_VALLEY)
        floor = d <= np.maximum(at[..., 1], 0.9 * EXTENT_M / side)
        fixed = floor.copy()
        if z is None:
            z = 1000.0 + 0.05 * y + 60.0 * fbm(x / 1500, y / 1500, 4, 11)
        else:
            step = EXTENT_M / side
            col, row = np.meshgrid(*[(np.arange(side) + 0.5) / 2.0 - 0.5] * 2)
            z = sample_cubic(z, col, row) + 0.15 * step * fbm(x / 180, y / 180, 2, 40 + side)
        z[floor] = at[..., 0][floor]
        for (ox, oy), height in (SOUTH_OUTLET, WEST_OUTLET):
            c, r = int(ox / EXTENT_M * side), int(oy / EXTENT_M * side)
            fixed[r, c], z[r, c] = True, height
        px, py = PASS_XY
        dip = 1.0 / (1.0 + ((x - px) / 1700) ** 2 + ((y - py) / 620) ** 2)
        mass = 1.0 - 0.82 * smoothstep(2300, 6200, abs(y - 5200) + 0.25 * abs(x - 5000))
        uplift = 4.6 * mass * (1.0 - 0.68 * dip) * (1.0 + 0.35 * fbm(x / 2300, y / 2300, 3, 23))
        rock = fbm(x / 900, y / 700, 3, 31)
        steepest = 0.86 + 0.34 * rock
        erodibility = 0.0115 * (1.0 + 0.25 * rock)
        z = erode(z, fixed, uplift, np.clip(steepest, 0.5, 1.3), erodibility, steps, dt)
    return 0.5 * (z + box_blur(z, 1))


def fine_heights(coarse):
    """`coarse` at 10 m, bent a little to hide its eight flow directions, with rock and gully detail."""
    x, y = centres(SIDE)
    wx = x + 70.0 * fbm(x / 800, y / 800, 2, 51) + 16.0 * fbm(x / 150, y / 150, 2, 53)
    wy = y + 70.0 * fbm(x / 800, y / 800, 2, 57) + 16.0 * fbm(x / 150, y / 150, 2, 59)
    step = EXTENT_M / coarse.shape[0]
    z = sample_cubic(coarse, wx / step - 0.5, wy / step - 0.5)
    gy, gx = np.gradient(box_blur(z, 2), CELL_M)
    slope = np.sqrt(gx * gx + gy * gy)
    high = smoothstep(1500, 2400, z)
    rough = smoothstep(0.25, 0.9, slope)
    crags = ridged(wx / 420, wy / 420, 5, 61) - 0.45
    z = z + crags * rough * (22.0 + 70.0 * high)
    z = z + fbm(wx / 90, wy / 90, 3, 71) * (0.4 + 3.2 * rough * (0.5 + high))
    return z


def valley_floor(z):
    """The main valley's floor: gravel terraces, alluvial fans at its feet, the river's bed."""
    x, y = centres(SIDE)
    d, at = nearest_on_line(x, y, MAIN_VALLEY)
    floor, half = at[..., 0], at[..., 1]
    inside = 1.0 - smoothstep(0.75, 1.12, d / half)
    bench = floor + 3.0 * smoothstep(0.25, 0.3, d / half) + 1.2 * value_noise(x / 240, y / 240, 81)
    z = z * (1.0 - inside) + bench * inside
    fan = floor + 8.0 + (np.maximum(d - 0.55 * half, 0.0)) * 0.16
    z = np.where(d < half + 260, np.maximum(z, np.minimum(fan, z + 45.0)), z)
    bed = smoothstep(18.0, 34.0, d)
    return z * bed + (floor - 4.0) * (1.0 - bed)


def scree(z, passes):
    """Loose rock slides to 37° where the slope is not solid rock; the rest keeps its cliffs."""
    x, y = centres(SIDE)
    solid = smoothstep(-0.05, 0.35, fbm(x / 500, y / 500, 3, 91))
    repose = (0.72 + 1.1 * solid) * CELL_M
    for _ in range(passes):
        move = np.zeros_like(z)
        for axis in (0, 1):
            step = np.diff(z, axis=axis)
            limit = np.minimum(*((repose[1:], repose[:-1]) if axis == 0 else (repose[:, 1:], repose[:, :-1])))
            flow = 0.2 * (np.maximum(step - limit, 0.0) + np.minimum(step + limit, 0.0))
            if axis == 0:
                move[1:] -= flow
                move[:-1] += flow
            else:
                move[:, 1:] -= flow
                move[:, :-1] += flow
        z = z + move
    return z
