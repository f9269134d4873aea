"""Keyword arguments in Python become options of the program."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import pytest

from corniche.bars import Bars
from corniche.errors import UsageError
from corniche.options import words_of
from corniche.records import error_of, record_of, stage_of, warning_of


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"max_error": 2.5, "layers": "areas"}, ["--max-error=2.5", "--layers=areas"]),
        ({"overwrite": True, "force": False, "osm": None}, ["--overwrite"]),
        ({"dem": [Path("a.tif"), "b c.tif"]}, ["--dem=a.tif", "--dem=b c.tif"]),
        ({"bounds": (-9.5, 46.8, 9.6, 46.9)}, ["--bounds=-9.5,46.8,9.6,46.9"]),
        ({"nodata": [-1, (0, 2)]}, ["--nodata=-1", "--nodata=0,2"]),
        # A keyword of Python.
        ({"from_": "here"}, ["--from=here"]),
    ],
)
def test_options_are_words(options: dict[str, object], words: list[str]) -> None:
    assert words_of(options) == words


def test_iterables_and_arrays_are_taken_by_the_same_rules(tmp_path: Path) -> None:
    (tmp_path / "a.tif").touch()
    assert words_of({"dem": tmp_path.glob("*.tif")}) == [f"--dem={tmp_path}/a.tif"]
    assert words_of({"way": range(2)}) == ["--way=0", "--way=1"]
    # Bounds are one value, whatever type they have.
    for bounds in ([-9.5, 46.8, 9.6, 46.9], (-9.5, 46.8, 9.6, 46.9), iter([-9.5, 46.8, 9.6, 46.9])):
        assert words_of({"bounds": bounds}) == ["--bounds=-9.5,46.8,9.6,46.9"]
    assert words_of({"bounds": "osm"}) == ["--bounds=osm"]
    assert words_of({"max_error": Fraction(5, 2), "crs": Decimal("1.50")}) == ["--max-error=2.5", "--crs=1.50"]


def test_numbers_of_numpy_are_numbers() -> None:
    numpy = pytest.importorskip("numpy")
    assert words_of({"overwrite": numpy.True_, "force": numpy.bool_(False)}) == ["--overwrite"]
    assert words_of({"bounds": numpy.array([9.5, 46.8, 9.6, 46.9])}) == ["--bounds=9.5,46.8,9.6,46.9"]
    assert words_of({"max_error": numpy.float32(0.1), "cell": numpy.array(2.5)}) == ["--max-error=0.1", "--cell=2.5"]
    assert words_of({"threads": numpy.int64(2)}) == ["--threads=2"]
    assert words_of({"way": numpy.array([116, 117])}) == ["--way=116", "--way=117"]
    with pytest.raises(UsageError, match="bounds="):
        words_of({"bounds": numpy.zeros((2, 2))})


@pytest.mark.parametrize("value", [{"a": 1}, {1, 2}, b"a.tif", object(), 1j, [[1, 2]], (True, False), (1, (2, 3)), [("a", object())], open])
def test_what_is_no_value_is_refused_with_its_name(value: object) -> None:
    with pytest.raises(UsageError, match=r"^dem_band=.* cannot be the value of an option"):
        words_of({"dem_band": value})


def test_records_are_read_and_text_is_left() -> None:
    assert record_of("corniche: text") is None and record_of("[1]") is None
    stage = stage_of({"stage": "tiles", "title": "creating tiles", "state": "end", "unit": "tiles", "done": 3, "total": 3, "new field": 1})
    assert stage is not None and (stage.done, stage.total, stage.seconds_left) == (3, 3, None)
    assert stage_of({"summary": []}) is None
    assert warning_of({"warning": "why"}) == "why" and warning_of({"level": "WARN", "message": "why"}) == "why"
    assert error_of({"end": {"error": "why"}}) == "why" and error_of({"level": "ERROR", "message": "why"}) == "why"
    assert error_of({"end": {"error": None}}) is None


def test_bars_follow_the_stages(capsys: pytest.CaptureFixture[str]) -> None:
    bars = Bars()
    for state, done in [("begin", 0), ("running", 2), ("end", 4)]:
        stage = stage_of({"stage": "tiles", "title": "creating tiles", "state": state, "unit": "tiles", "done": done, "total": 4})
        assert stage is not None
        bars(stage)
    bars.close()
    assert "creating tiles" in capsys.readouterr().err
