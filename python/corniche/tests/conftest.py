"""Fixtures of the tests: the program, and a package of the sample."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import corniche
from corniche.program import PACKED, VARIABLE

#: A large error bound gives few triangles, so the build is fast.
COARSE = {"max_error": 20, "dem_vertical_crs": "EPSG:5773"}


@pytest.fixture(scope="session")
def program() -> str:
    """The program under test, from ``$CORNICHE`` or from the installed wheel."""
    assert os.environ.get(VARIABLE) or PACKED.is_file(), "name the program in $CORNICHE; scripts/test-python does"
    return corniche.find_program()


@pytest.fixture(scope="session")
def package(program: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A package of the sample."""
    path = tmp_path_factory.mktemp("package") / "pass.pmtiles"
    corniche.build(path, **corniche.sample(), **COARSE)
    return path
