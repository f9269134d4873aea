"""Limits of processes, keys of tasks, sizes as text."""

from __future__ import annotations

from dataclasses import replace

import pytest
from dask.utils import key_split

from corniche.errors import UsageError
from corniche_dask.jobs import Job
from corniche_dask.limits import WORKER_BYTES, limits_of, parse_bytes, slots_of
from corniche_dask.tasks import Setting, key_of, part_of_name, stores_of

GIB = 1 << 30
SETTING = Setting("f" * 64, "corniche 1", None, ("/store",), None, None, None, "/out.pmtiles", False, None)
TILES = Job("tiles-1-0-0", "tiles", "1/0/0", None, 5.0, ("top",), ("--step", "tiles", "--subtree", "1/0/0"))


def test_a_slot_has_its_share_of_the_worker() -> None:
    four = limits_of("w", 4, 4 * GIB + WORKER_BYTES, {})
    assert (four.threads, four.memory_bytes) == (1, GIB)
    one = limits_of("w", 4, 4 * GIB + WORKER_BYTES, {"slot": 1})
    assert (one.threads, one.memory_bytes) == (4, 4 * GIB)
    two = limits_of("w", 5, 4 * GIB + WORKER_BYTES, {"slot": 2.0})
    assert (two.threads, two.memory_bytes) == (2, 2 * GIB)


def test_what_is_asked_for_comes_first() -> None:
    asked = limits_of("w", 4, 4 * GIB, {}, 3, GIB)
    assert (asked.threads, asked.memory_bytes) == (3, GIB)
    assert limits_of("w", 2, None, {}).memory_bytes == 4 * GIB


def test_too_little_memory_is_told() -> None:
    with pytest.raises(UsageError, match="worker w has 1024 MiB for 8 parts"):
        limits_of("w", 8, GIB, {})


def test_slots_are_declared_or_threads() -> None:
    threads = {"a": {"nthreads": 2, "resources": {}}, "b": {"nthreads": 3}}
    assert slots_of(threads) == (5, False)
    # Workers without slots, such as those of other jobs, get nothing.
    assert slots_of({"a": {"nthreads": 2, "resources": {"slot": 1}}, "b": {"nthreads": 3}}) == (1, True)
    assert slots_of({}) == (0, False)


@pytest.mark.parametrize(
    ("text", "size"),
    [("512M", 512 << 20), ("4g", 4 * GIB), ("1.5G", 3 * GIB // 2), ("1T", 1 << 40), ("1000", 1000), ("8GB", 8 * 10**9), ("448MiB", 448 << 20)],
)
def test_sizes(text: str, size: int) -> None:
    assert parse_bytes(text) == size


@pytest.mark.parametrize("text", ["", "G", "-1G", "0", "4GX", "4MGB", "iB", "inf", "nan"])
def test_what_is_no_size(text: str) -> None:
    with pytest.raises(UsageError):
        parse_bytes(text)


def test_equal_work_has_equal_keys() -> None:
    key = key_of(SETTING, TILES)
    assert key == key_of(SETTING, replace(TILES, id="another", work=9.0, after=()))
    others = [
        key_of(replace(SETTING, plan_digest="e" * 64), TILES),
        key_of(replace(SETTING, stores=("/elsewhere",)), TILES),
        key_of(SETTING, replace(TILES, subtree="1/1/0")),
        key_of(SETTING, replace(TILES, step="heights")),
        key_of(SETTING, replace(TILES, share="1/2")),
    ]
    assert len({key, *others}) == 6
    # The limits of a process do not change its result.
    assert key == key_of(replace(SETTING, threads=7, memory_bytes=GIB), TILES)


def test_packages_elsewhere_have_other_keys() -> None:
    merge = Job("merge", "merge", None, None, 1.0, ("tiles",), ())
    keys = {key_of(replace(SETTING, output=output), merge) for output in ("/a.pmtiles", "/b.pmtiles")}
    assert len(keys) == 2


@pytest.mark.parametrize("step", ["hashes", "ways", "nodes", "roads", "heights", "top", "tiles", "merge"])
def test_the_dashboard_shows_the_step(step: str) -> None:
    for number in range(200):
        assert key_split(key_of(SETTING, replace(TILES, step=step, subtree=f"9/{number}/0"))) == step


def test_names_of_parts() -> None:
    assert part_of_name("/store/parts/tiles-1-0-0.0a1b.part\n") == ("tiles-1-0-0.0a1b.part", "0a1b")
    assert part_of_name("") == (None, None)


def test_stores_are_absolute_or_elsewhere() -> None:
    assert stores_of("s3://bucket/prefix") == ("s3://bucket/prefix",)
    first, second = stores_of(["a", "/b"])
    assert first.startswith("/") and first.endswith("/a") and second == "/b"
