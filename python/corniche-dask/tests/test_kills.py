"""Workers, nannies, scheduler, client and children are killed at seeded moments: the repeated command then writes the same bytes, without leftovers.

``CORNICHE_KILLS`` sets the number of kills, which is small in CI; scripts/torture sets more.
"""

from __future__ import annotations

import os
import random
import time
from pathlib import Path

import pytest

from conftest import Planned, none_left
from rig import KINDS, PATIENCE, Rig

KILLS = int(os.environ.get("CORNICHE_KILLS") or (2 if os.environ.get("CORNICHE_TIER") == "ci" else 6))
#: The command is repeated at most this often.
TRIES = 5
#: The time limit of one run, in seconds.
RUNS_WITHIN = 300.0


def kinds_of(seed: int) -> str:
    """Each kind in turn, so that few seeds cover all kinds."""
    return KINDS[seed % len(KINDS)]


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Rig:
    """One cluster for all kills; killed processes are started again."""
    with Rig(tmp_path_factory.mktemp("rig")) as rig:
        yield rig  # type: ignore[misc]


@pytest.fixture(scope="module")
def parts(rig: Rig, planned: Planned, tmp_path_factory: pytest.TempPathFactory) -> int:
    """The number of parts of an undisturbed build."""
    folder = tmp_path_factory.mktemp("undisturbed")
    client = rig.begin(planned.corniche, planned.plan, folder / "store", folder / "out.pmtiles")
    assert client.wait(RUNS_WITHIN) == 0
    assert (folder / "out.pmtiles").read_bytes() == planned.bytes
    return sealed(folder / "store")


def sealed(store: Path) -> int:
    """The number of parts in a store."""
    return len(list(store.glob("parts/*.part")))


@pytest.mark.parametrize("seed", range(KILLS))
def test_a_kill_changes_nothing(seed: int, rig: Rig, parts: int, planned: Planned, tmp_path: Path) -> None:
    chance = random.Random(seed)
    kind = kinds_of(seed)
    store, package = tmp_path / "store", tmp_path / "out.pmtiles"
    # Counted in parts, not in seconds: machines differ.
    made_before, delay = chance.randrange(parts - 1), 0.3 * chance.random()
    killed, tries, begun = False, 0, time.monotonic()
    while True:
        tries += 1
        assert tries <= TRIES, f"seed {seed}: {kind} killed after {made_before} parts, and the command failed {TRIES} times"
        rig.repair()
        client = rig.begin(planned.corniche, planned.plan, store, package)
        while client.poll() is None:
            if not killed and sealed(store) >= made_before:
                time.sleep(delay)
                killed = rig.kill(kind, client, store, chance.randrange(100))
            time.sleep(0.02)
            assert time.monotonic() - begun < RUNS_WITHIN
        if client.returncode == 0:
            break
    assert killed, f"seed {seed}: no {kind} was killed after {made_before} parts"
    # Dask recovers from the loss of any process except the client and the scheduler.
    assert tries == 1 or kind in ("client", "scheduler"), f"seed {seed}: {kind} killed, and the command had to be given again"
    assert package.read_bytes() == planned.bytes
    none_left(str(store), PATIENCE)
    planned.check_store(store, tmp_path)
    if kind == "scheduler":
        assert "is lost; progress is saved in the store" in rig.log()
