"""Fixtures of the tests: the program, the sample, clusters, and checks for leftovers."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from distributed import Client, LocalCluster

ROOT = Path(__file__).resolve().parents[3]
PASS = ROOT / "data-samples" / "pass"
FAKE = Path(__file__).with_name("fake_corniche.py")
#: Options of ``corniche plan`` and ``build``.
#: Options that split the small sample into many parts.
LEAST_WORK = 0.05
INPUTS = ["--dem", str(PASS / "pass-dem.tif"), "--osm", str(PASS / "pass.osm.pbf"), "--max-error", "2"]


@pytest.fixture(scope="session")
def corniche() -> str:
    """The program under test, from ``$CORNICHE``."""
    program = os.environ.get("CORNICHE")
    assert program and Path(program).is_file(), "name the program in $CORNICHE; scripts/test-dask does"
    return program


class Planned:
    """A plan, and the package that one process builds from it."""

    def __init__(self, corniche: str, folder: Path, inputs: list[str]) -> None:
        self.corniche = corniche
        self.inputs = inputs
        self.plan = folder / "plan.json"
        whole = folder / "whole.pmtiles"
        self.run("plan", *inputs, "-o", str(self.plan))
        self.run("build", "--quiet", *inputs, "-o", str(whole))
        self.bytes = whole.read_bytes()

    def run(self, *arguments: str) -> str:
        """Runs the program, which must succeed."""
        ran = subprocess.run([self.corniche, *arguments], capture_output=True, text=True, check=False)
        assert ran.returncode == 0, ran.stderr
        return ran.stdout

    def check_store(self, store: Path, folder: Path) -> None:
        """Asserts that a merge of the store writes the same package, and that all files among its parts are complete."""
        merged = folder / "merged-from-store.pmtiles"
        self.run("merge", str(self.plan), "--quiet", "--store", str(store), "-o", str(merged))
        assert merged.read_bytes() == self.bytes, "another package than build makes"
        merged.unlink()
        names = [path.name for path in (store / "parts").iterdir()]
        assert names and all(name.endswith(".part") for name in names), names


@pytest.fixture(scope="session")
def planned(corniche: str, tmp_path_factory: pytest.TempPathFactory) -> Planned:
    """The plan of the sample ``pass``, with roads."""
    return Planned(corniche, tmp_path_factory.mktemp("planned"), INPUTS)


@pytest.fixture
def local() -> Iterator[Callable[..., Client]]:
    """Starts clusters of processes on this machine; they end with the test."""
    begun: list[tuple[Client, LocalCluster]] = []

    def start(workers: int, threads: int = 1, **options: object) -> Client:
        cluster = LocalCluster(n_workers=workers, threads_per_worker=threads, dashboard_address=":0", host="127.0.0.1", **options)
        client = Client(cluster)
        begun.append((client, cluster))
        return client

    yield start
    for client, cluster in begun:
        client.close()
        cluster.close()


def processes_of(word: str) -> dict[int, str]:
    """Command lines of the processes of ``corniche part`` and ``merge``, real or fake, that contain the given text."""
    found = {}
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit() and int(folder.name) != os.getpid():
            try:
                line = (folder / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
            except OSError:
                continue
            if word in line and (" part " in line or " merge " in line):
                found[int(folder.name)] = line
    return found


def none_left(word: str, within: float = 20.0) -> None:
    """Asserts that all processes of corniche whose command line contains the given text end."""
    end = time.monotonic() + within
    while (left := processes_of(word)) and time.monotonic() < end:
        time.sleep(0.1)
    assert not left, f"left behind: {left}"
