"""UTM zone 32N to WGS84, without a library, so that the sample depends on no PROJ version."""

import math

# WGS84; series of Krüger 1912 in the third flattening, to the third order (0.1 mm within the zone).
_A, _F = 6378137.0, 1 / 298.257223563
_N = _F / (2 - _F)
_RADIUS = _A / (1 + _N) * (1 + _N**2 / 4 + _N**4 / 64)
_BETA = (
    _N / 2 - 2 * _N**2 / 3 + 37 * _N**3 / 96,
    _N**2 / 48 + _N**3 / 15,
    17 * _N**3 / 480,
)
_DELTA = (2 * _N - 2 * _N**2 / 3 - 2 * _N**3, 7 * _N**2 / 3 - 8 * _N**3 / 5, 56 * _N**3 / 15)
_CENTRAL_DEG, _SCALE, _FALSE_EASTING_M = 9.0, 0.9996, 500000.0


def from_utm(easting_m, northing_m):
    """Longitude and latitude in degrees."""
    xi = northing_m / (_SCALE * _RADIUS)
    eta = (easting_m - _FALSE_EASTING_M) / (_SCALE * _RADIUS)
    xi0, eta0 = xi, eta
    for j, b in enumerate(_BETA, 1):
        xi0 -= b * math.sin(2 * j * xi) * math.cosh(2 * j * eta)
        eta0 -= b * math.cos(2 * j * xi) * math.sinh(2 * j * eta)
    chi = math.asin(math.sin(xi0) / math.cosh(eta0))
    phi = chi + sum(d * math.sin(2 * j * chi) for j, d in enumerate(_DELTA, 1))
    lam = math.atan2(math.sinh(eta0), math.cos(xi0))
    return _CENTRAL_DEG + math.degrees(lam), math.degrees(phi)
