"""The sample data of this package: an invented mountain pass of 10 by 10 kilometres."""

from __future__ import annotations

from pathlib import Path

from .errors import CornicheError

_NAMES = {"dem": "pass-dem.tif", "osm": "pass.osm.pbf"}


def sample() -> dict[str, Path]:
    """The paths of an elevation raster and an extract: ``build("pass.pmtiles", **sample())``."""
    here = Path(__file__)
    # In a wheel, and in the repository.
    for folder in [here.with_name("sample"), *(above / "data-samples" / "pass" for above in here.parents[4:5])]:
        found = {name: folder / file for name, file in _NAMES.items()}
        if all(path.is_file() for path in found.values()):
            return found
    raise CornicheError("this installation of corniche has no sample; it is in data-samples/pass of the repository")
