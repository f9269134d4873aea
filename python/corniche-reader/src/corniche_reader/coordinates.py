"""Conversion between WGS84 degrees and working metres (`coordinates` of the manifest, section 2 of the format)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import ContainerError
from .grid import FARTHEST_M

Array = NDArray[np.float64]
#: The iteration has converged when a step is smaller than this.
CLOSE_M = 1e-6
#: The largest continuous longitude in degrees: 65 turns (section 11 of the format).
MOST_DEGREES = 65 * 360


class Coordinates:
    """The table of longitudes and latitudes over the working metres."""

    def __init__(self, manifest: dict[str, Any]) -> None:
        try:
            table = manifest["coordinates"]
            self._low = np.array([float(table["bounds"][name]) for name in ("min_x", "min_y")])
            self._span = np.array([float(table["bounds"][name]) for name in ("max_x", "max_y")]) - self._low
            size = int(table["size"])
            self._samples = np.array(table["samples_deg"], np.float64)
        except (KeyError, TypeError, ValueError, OverflowError) as cause:
            raise ContainerError(f"the manifest's table of coordinates is incomplete: {cause}") from cause
        # Comparisons with NaN are false.
        is_near = (np.abs(self._low) <= FARTHEST_M).all() and (self._span <= 2 * FARTHEST_M).all() and (np.abs(self._samples) <= MOST_DEGREES).all()
        if not (4 <= size <= 129 and self._samples.shape == (size * size, 2) and is_near and (self._span > 0).all()):
            raise ContainerError("the manifest's table of coordinates is corrupt")
        self._samples = self._samples.reshape(size, size, 2)
        self._last = size - 1

    def degrees(self, positions: ArrayLike) -> Array:
        """The [longitude, latitude] of each [x, y, …] in working metres; longitudes are within ±180."""
        places = np.asarray(positions, np.float64)
        found = self._interpolated(places.reshape(-1, places.shape[-1])[:, :2])
        found[:, 0] -= 360 * np.round(found[:, 0] / 360)
        return found.reshape(*places.shape[:-1], 2)

    def working(self, lon: float, lat: float) -> tuple[float, float] | None:
        """The [x, y] in working metres of a position in degrees; None far outside the data."""
        at = self._low + self._span / 2
        center = self._interpolated(at[None])[0]
        target = np.array([lon - 360 * round((lon - center[0]) / 360), lat])
        reach = self._span / 100
        for _ in range(30):
            beside = np.array([at, at + [reach[0], 0], at - [reach[0], 0], at + [0, reach[1]], at - [0, reach[1]]])
            here, ahead_x, behind_x, ahead_y, behind_y = self._interpolated(beside)
            slopes = np.column_stack([(ahead_x - behind_x) / (2 * reach[0]), (ahead_y - behind_y) / (2 * reach[1])])
            try:
                step = np.linalg.solve(slopes, target - here)
            except np.linalg.LinAlgError:
                return None
            at = at + step
            if not np.isfinite(at).all() or (np.abs(at - self._low) > 3 * self._span).any():
                return None
            if np.hypot(*step) < CLOSE_M:
                return float(at[0]), float(at[1])
        return None

    def _interpolated(self, places: Array) -> Array:
        """Lagrange's cubic through the four samples around each position, along both axes; at the edge through the outermost four."""
        t = (places - self._low) / self._span * self._last
        first = np.clip(np.floor(t) - 1, 0, self._last - 3).astype(np.int64)
        s = t - first
        weights = np.stack(
            [
                -(s - 1) * (s - 2) * (s - 3) / 6,
                s * (s - 2) * (s - 3) / 2,
                -s * (s - 1) * (s - 3) / 2,
                s * (s - 1) * (s - 2) / 6,
            ]
        )
        found = np.zeros((len(places), 2))
        for r in range(4):
            for c in range(4):
                found += (weights[r, :, 1] * weights[c, :, 0])[:, None] * self._samples[first[:, 1] + r, first[:, 0] + c]
        return found
