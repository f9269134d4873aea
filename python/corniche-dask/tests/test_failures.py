"""The reaction of a build to failing parts, workers and programs, with a program that fails on demand."""

from __future__ import annotations

import json
import os
import signal
import stat
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from distributed import Client, LocalCluster

from conftest import FAKE, none_left
from corniche.errors import CornicheError, ProgramError, TargetExists
from corniche_dask import PartFailed, PartRefused, Summary, build
from corniche_dask.build import RETRIES
from corniche_dask.cli import main
from corniche_dask.worker import make_part
from test_jobs import line

Local = Callable[..., Client]


@pytest.fixture(scope="module")
def two() -> Iterator[Client]:
    """A client of two workers, for tests that need nothing else."""
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0", host="127.0.0.1") as cluster, Client(cluster) as client:
        yield client


@pytest.fixture
def fake(tmp_path: Path) -> str:
    """The fake program, for this interpreter."""
    program = tmp_path / "fake-corniche"
    program.write_text(f"#!{sys.executable}\n" + FAKE.read_text().split("\n", 1)[1])
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    return str(program)


def part(name: str, step: str, work: float = 1.0, after: tuple[str, ...] = ()) -> dict[str, Any]:
    return {**line(name, step, work, after), "args": ["--id", name]}


PARTS = [
    part("roads", "roads", 5),
    part("heights-a", "heights", 2),
    part("heights-b", "heights", 3),
    part("top", "top", 1, ("heights",)),
    part("tiles-a", "tiles", 4, ("roads", "top")),
    part("tiles-b", "tiles", 4, ("roads", "top")),
    line("merge", "merge", 1, ("tiles",)),
]


class Made:
    """A build of a plan of the fake program."""

    def __init__(self, folder: Path, fake: str, **acts: dict[str, Any]) -> None:
        self.folder = folder
        self.fake = fake
        self.plan = folder / "plan.json"
        self.plan.write_text(json.dumps({"generator": "corniche 9.9.9", "inputs": [], "jobs": PARTS, "acts": acts}))
        self.store = folder / "work" / "store"
        self.package = folder / "out.pmtiles"

    def build(self, client: Client, **options: Any) -> Summary:
        self.store.parent.mkdir(exist_ok=True)
        return build(client, self.plan, str(self.store), str(self.package), corniche=self.fake, memory_bytes=256 << 20, **options)

    def calls(self) -> list[str]:
        """The parts that were begun."""
        return [line.split()[0] for line in (self.store.parent / "calls").read_text().splitlines()]


def test_parts_are_made_in_their_order(tmp_path: Path, fake: str, two: Client) -> None:
    made = Made(tmp_path, fake)
    summary = made.build(two)
    assert made.package.read_text() == "package\n"
    calls = made.calls()
    assert sorted(calls) == sorted(part["id"] for part in PARTS)
    assert calls.index("top") > max(calls.index("heights-a"), calls.index("heights-b"))
    assert calls[-1] == "merge" and set(calls[-3:-1]) == {"tiles-a", "tiles-b"}
    result = next(part for part in summary.parts if part.id == "tiles-a")
    assert (result.name, result.digest, result.file_bytes) == ("tiles-a.0123456789abcdef.part", "0123456789abcdef", 7)
    assert result.was_made and result.peak_bytes is not None and not summary.above_memory()
    assert "tiles" in summary.to_text() and summary.to_json()["parts"]


def test_a_part_that_fails_is_tried_again(tmp_path: Path, fake: str, two: Client) -> None:
    made = Made(tmp_path, fake, **{"tiles-a": {"exit": 1, "times": RETRIES}})
    made.build(two)
    assert made.calls().count("tiles-a") == RETRIES + 1


def test_a_part_that_fails_again_and_again_ends_the_build_with_its_log(tmp_path: Path, fake: str, two: Client) -> None:
    made = Made(tmp_path, fake, **{"tiles-a": {"exit": 1}})
    with pytest.raises(PartFailed) as failed:
        made.build(two)
    told = str(failed.value)
    for piece in ["tiles-a", "step tiles", "tcp://127.0.0.1", "exit code 1", "corniche: the fake tiles-a was told to fail"]:
        assert piece in told
    assert "stage" not in told, "progress is left out"
    assert made.calls().count("tiles-a") == RETRIES + 1
    assert not made.package.exists()


@pytest.mark.parametrize("code", [2, 3])
def test_unusable_input_is_not_tried_again(code: int, tmp_path: Path, fake: str, two: Client) -> None:
    made = Made(tmp_path, fake, roads={"exit": code}, **{"heights-a": {"sleep": 600}})
    client = two
    with pytest.raises(PartRefused, match=f"exit code {code}") as failed:
        made.build(client)
    assert failed.value.exit_code == code
    assert made.calls().count("roads") == 1
    # The other, running part is cancelled, and its process ends.
    none_left(str(made.store))
    assert client.status == "running"


def test_a_killed_child_is_made_again(tmp_path: Path, fake: str, two: Client) -> None:
    made = Made(tmp_path, fake, top={"exit": -9, "times": 1})
    # An exit code below 0 is 247 for the caller: any code except 0, 2 and 3 is retried.
    made.build(two)
    assert made.calls().count("top") == 2


def test_a_killed_worker_leaves_no_child_and_its_part_is_made_elsewhere(tmp_path: Path, fake: str, local: Local) -> None:
    made = Made(tmp_path, fake, **{"heights-a": {"sleep": 600, "times": 1}})
    killed = []

    def kill_worker() -> None:
        calls = made.store.parent / "calls"
        while not killed:
            begun = [call.split() for call in calls.read_text().splitlines()] if calls.exists() else []
            for child in (int(pid) for name, pid in begun if name == "heights-a"):
                worker = int(Path(f"/proc/{child}/stat").read_text().rsplit(")", 1)[1].split()[1])
                os.kill(worker, signal.SIGKILL)
                killed.append(child)
            time.sleep(0.05)

    thread = threading.Thread(target=kill_worker)
    thread.start()
    made.build(local(2))
    thread.join()
    none_left(str(made.store), within=5)
    assert made.calls().count("heights-a") == 2 and made.package.exists()


def test_another_version_on_a_worker_is_told_before_anything_is_made(tmp_path: Path, fake: str, local: Local) -> None:
    made = Made(tmp_path, fake)
    client = local(2, env={"FAKE_VERSION": "corniche 1.0.0"})
    with pytest.raises(ProgramError) as failed:
        made.build(client)
    told = str(failed.value)
    assert "corniche 1.0.0" in told and "created by corniche 9.9.9" in told
    assert all(worker in told for worker in client.scheduler_info(n_workers=-1)["workers"])
    assert not (made.store.parent / "calls").exists()


def test_a_worker_without_the_program_is_told(tmp_path: Path, fake: str, two: Client) -> None:
    made = Made(tmp_path, str(tmp_path / "none"))
    with pytest.raises(ProgramError, match="there is no program"):
        made.build(two)


def test_a_package_that_is_there_is_kept(tmp_path: Path, fake: str, two: Client) -> None:
    made = Made(tmp_path, fake)
    made.package.write_text("mine")
    client = two
    with pytest.raises(TargetExists, match="pass -O to overwrite it"):
        made.build(client)
    assert made.package.read_text() == "mine" and not (made.store.parent / "calls").exists()
    made.build(client, overwrite=True)
    assert made.package.read_text() == "package\n"


def test_memory_above_the_limit_is_an_error_of_the_run(tmp_path: Path, fake: str, capsys: pytest.CaptureFixture[str]) -> None:
    made = Made(tmp_path, fake, **{"tiles-b": {"megabytes": 300, "sleep": 1.5}, "tiles-a": {"megabytes": 150, "sleep": 1.5}})
    made.store.parent.mkdir()
    options = ["--local", "1", "--threads-per-worker", "1", "--memory", "256M", "--corniche", fake]
    files = ["--plan", str(made.plan), "--store", str(made.store), "-o", str(made.package)]
    assert main(["build", *options, *files, "-q"]) == 1
    told = capsys.readouterr().err
    assert "part tiles-b used 3" in told and "MiB of 256 MiB" in told, told
    assert "tiles-a" not in told
    assert made.package.exists()


def test_a_build_asks_the_store_and_not_what_it_remembers(tmp_path: Path, fake: str, two: Client) -> None:
    made = Made(tmp_path, fake)
    client = two
    made.build(client)
    made.package.unlink()
    (made.store / "parts" / "tiles-a.0123456789abcdef.part").unlink()
    again = made.build(client)
    assert [part.id for part in again.parts if part.was_made] == ["tiles-a", "merge"]


def test_slots_bound_what_is_made_at_once(tmp_path: Path, fake: str, local: Local) -> None:
    """A worker of four threads that declares one slot runs one part at a time, with all threads."""
    made = Made(tmp_path, fake)
    summary = made.build(local(1, 4, resources={"slot": 1}))
    assert summary.slots == 1 and {part.threads for part in summary.parts} == {4}


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--local", "1"], "nothing to build"),
        (["--local", "1", "--plan", "p.json", "--dem", "a.tif"], "--dem is an option of corniche plan"),
        (["--scheduler", "tcp://127.0.0.1:1", "--memory-limit", "1G", "--dem", "a"], "need --local"),
    ],
)
def test_wrong_usage(arguments: list[str], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = ["--store", str(tmp_path / "s"), "-o", str(tmp_path / "o.pmtiles")]
    assert main(["build", *arguments, *files]) == 2
    assert told in capsys.readouterr().err


def test_errors_of_workers_are_those_of_this_package() -> None:
    """Errors keep their text and their exit code when they are pickled."""
    import pickle

    for error in [PartFailed("why"), PartRefused("why", 3), ProgramError("why")]:
        again = pickle.loads(pickle.dumps(error))
        assert isinstance(again, CornicheError)
        assert (type(again), str(again), again.exit_code) == (type(error), "why", error.exit_code)


def test_parts_are_made_by_a_function_that_workers_can_import() -> None:
    assert make_part.__module__ == "corniche_dask.worker" and os.environ is not None
