"""Deterministic noise and resampling.

Only IEEE additions, multiplications, divisions and square roots are used, so that every machine gets the
same bits; numpy's random streams and its vectorised sine are not promised to.
"""

import numpy as np

SEED = 20110831


def hash_unit(i, j, salt):
    """A number in [0, 1) for the integer lattice point (i, j): splitmix64, Steele et al. 2014."""
    with np.errstate(over="ignore"):
        h = i.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
        h ^= j.astype(np.uint64) * np.uint64(0xC2B2AE3D27D4EB4F)
        h += np.uint64((SEED * 1_000_003 + salt) & (2**64 - 1)) * np.uint64(0xD6E8FEB86659FD93)
        h = (h ^ (h >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        h = (h ^ (h >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        h ^= h >> np.uint64(31)
    return (h >> np.uint64(11)).astype(np.float64) * 2.0**-53


def value_noise(x, y, salt):
    """Smooth noise in [-1, 1] with features of size 1 (quintic fade, Perlin 2002)."""
    i, j = np.floor(x), np.floor(y)
    u, v = x - i, y - j
    i, j = i.astype(np.int64), j.astype(np.int64)
    u = u * u * u * (u * (u * 6.0 - 15.0) + 10.0)
    v = v * v * v * (v * (v * 6.0 - 15.0) + 10.0)
    a, b = hash_unit(i, j, salt), hash_unit(i + 1, j, salt)
    c, d = hash_unit(i, j + 1, salt), hash_unit(i + 1, j + 1, salt)
    return 2.0 * ((a + (b - a) * u) * (1.0 - v) + (c + (d - c) * u) * v) - 1.0


def fbm(x, y, octaves, salt, gain=0.5):
    """Fractal sum of `value_noise`; each octave is turned by the 3-4-5 angle to hide the lattice."""
    total, amplitude = np.zeros_like(x), 1.0
    for octave in range(octaves):
        total = total + amplitude * value_noise(x, y, salt + octave)
        x, y = 2.0 * (0.8 * x - 0.6 * y) + 17.25, 2.0 * (0.6 * x + 0.8 * y) - 9.75
        amplitude *= gain
    return total


def ridged(x, y, octaves, salt):
    """Ridged multifractal noise in about [0, 1] (Musgrave, Kolb & Mace 1989)."""
    total, amplitude, weight = np.zeros_like(x), 0.5, np.ones_like(x)
    for octave in range(octaves):
        ridge = 1.0 - np.abs(value_noise(x, y, salt + octave))
        ridge = ridge * ridge * weight
        weight = np.clip(ridge * 1.6, 0.0, 1.0)
        total = total + amplitude * ridge
        x, y = 2.0 * (0.8 * x - 0.6 * y) + 31.5, 2.0 * (0.6 * x + 0.8 * y) - 4.125
        amplitude *= 0.55
    return total


def sample_cubic(grid, col, row):
    """`grid` at fractional (col, row): Catmull-Rom, edges repeated."""
    rows, cols = grid.shape
    i, j = np.floor(col), np.floor(row)
    u, v = col - i, row - j
    i, j = i.astype(np.int64), j.astype(np.int64)

    def weights(t):
        return (
            ((-0.5 * t + 1.0) * t - 0.5) * t,
            (1.5 * t - 2.5) * t * t + 1.0,
            ((-1.5 * t + 2.0) * t + 0.5) * t,
            (0.5 * t - 0.5) * t * t,
        )

    total = np.zeros_like(col)
    for dj, wv in enumerate(weights(v)):
        jj = np.clip(j + dj - 1, 0, rows - 1)
        line = np.zeros_like(col)
        for di, wu in enumerate(weights(u)):
            line = line + wu * grid[jj, np.clip(i + di - 1, 0, cols - 1)]
        total = total + wv * line
    return total


def sample_linear(grid, col, row):
    """`grid` at fractional (col, row): bilinear, edges repeated."""
    rows, cols = grid.shape
    col, row = np.clip(col, 0.0, cols - 1.0), np.clip(row, 0.0, rows - 1.0)
    i = np.minimum(np.floor(col).astype(np.int64), cols - 2)
    j = np.minimum(np.floor(row).astype(np.int64), rows - 2)
    u, v = col - i, row - j
    north = grid[j, i] * (1.0 - u) + grid[j, i + 1] * u
    south = grid[j + 1, i] * (1.0 - u) + grid[j + 1, i + 1] * u
    return north * (1.0 - v) + south * v


def box_blur(grid, radius):
    """Mean over a (2·radius + 1)² window, edges repeated; sums run in one fixed order."""
    for axis in (0, 1):
        pad = [(0, 0), (0, 0)]
        pad[axis] = (radius + 1, radius)
        total = np.cumsum(np.pad(grid, pad, mode="edge"), axis=axis)
        width = 2 * radius + 1
        after = np.take(total, np.arange(width, total.shape[axis]), axis=axis)
        before = np.take(total, np.arange(0, total.shape[axis] - width), axis=axis)
        grid = (after - before) / width
    return grid


def smoothstep(low, high, x):
    """0 below `low`, 1 above `high`, smooth between."""
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def catmull_rom(points, pieces):
    """A smooth curve through `points` (rows of any width), `pieces` steps for each span."""
    points = np.asarray(points, dtype=np.float64)
    ends = np.vstack([2 * points[0] - points[1], points, 2 * points[-1] - points[-2]])
    out = []
    for k in range(1, len(ends) - 2):
        p0, p1, p2, p3 = ends[k - 1 : k + 3]
        for s in range(pieces):
            t = s / pieces
            out.append(
                p1 + 0.5 * t * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)))
            )
    out.append(points[-1])
    return np.array(out)


def nearest_on_line(x, y, line):
    """Distance of every (x, y) from the polyline `line` (columns x, y, value…) and the values there."""
    best = np.full(x.shape, np.inf)
    values = np.zeros(x.shape + (line.shape[1] - 2,))
    for a, b in zip(line[:-1], line[1:]):
        dx, dy = b[0] - a[0], b[1] - a[1]
        t = np.clip(((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy), 0.0, 1.0)
        ex, ey = x - (a[0] + t * dx), y - (a[1] + t * dy)
        d = ex * ex + ey * ey
        closer = d < best
        best[closer] = d[closer]
        values[closer] = a[2:] + t[closer][:, None] * (b[2:] - a[2:])
    return np.sqrt(best), values
