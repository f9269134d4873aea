"""Functions run the program and return its documents, its progress, its warnings and its errors."""

from __future__ import annotations

import re
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest

import corniche
from conftest import COARSE
from corniche import Stage
from corniche.options import ONE_VALUE
from corniche.running import TELL_PROGRESS


def test_a_build_returns_what_the_package_holds_and_tells_how_far_it_is(program: str, tmp_path: Path) -> None:
    told: list[Stage] = []
    made = corniche.build(tmp_path / "pass.pmtiles", **corniche.sample(), **COARSE, layers="areas", progress=told.append)
    assert made["manifest"]["generator"].startswith("corniche ")
    assert made == corniche.info(tmp_path / "pass.pmtiles")
    ended = {stage.stage for stage in told if stage.state == "end"}
    assert {"extract", "heights", "tiles", "package"} <= ended, ended
    assert all(stage.total is None or stage.done <= stage.total for stage in told)


def test_a_plan_tells_what_a_build_takes_and_is_written_if_asked_for(program: str, tmp_path: Path) -> None:
    told = corniche.plan(**corniche.sample(), **COARSE)
    assert told["estimate"]["nodes"] == 1_000_000
    assert corniche.plan(output=tmp_path / "plan.json", **corniche.sample(), **COARSE)["estimate"]["tiles"] == told["estimate"]["tiles"]
    assert (tmp_path / "plan.json").is_file()


def test_verify_returns_the_checks_and_raises_if_one_fails(package: Path, tmp_path: Path) -> None:
    found = corniche.verify(package, **corniche.sample())
    assert found["holds"] and len(found["checks"]) > 40
    # Changes one byte of the tiles, which have a checksum.
    broken = tmp_path / "broken.pmtiles"
    changed = bytearray(package.read_bytes())
    changed[len(changed) - 2000] ^= 1
    broken.write_bytes(changed)
    # Without and with the inputs, with which some checks have no case: these neither hold nor are
    # broken.
    no_inputs: dict[str, Any] = {}
    for inputs in (no_inputs, corniche.sample()):
        with pytest.raises(corniche.PromiseBroken, match=r"broken.pmtiles breaks .* of its promises: .*tiles.whole") as raised:
            corniche.verify(broken, **inputs)
        document = raised.value.document
        assert not document["holds"] and raised.value.exit_code == 1
        names = [check["id"] for check in document["checks"] if check["holds"] is False]
        assert f"breaks {len(names)} of its promises" in str(raised.value)
        assert re.findall(r"([a-z_.-]+) \(", str(raised.value).partition("promises: ")[2])[:1] == names[:1]
    assert any(check["holds"] is None for check in document["checks"])


def test_an_export_is_a_file_for_others(package: Path, tmp_path: Path) -> None:
    path = corniche.export("roads", package, tmp_path / "roads.geojson", crs="EPSG:4979")
    assert path.read_text(encoding="utf-8").startswith("{")
    with pytest.raises(corniche.TargetExists, match=r"roads.geojson\" .*overwrite=True") as raised:
        corniche.export("roads", package, path, crs="EPSG:4979")
    assert raised.value.exit_code == 3
    corniche.export("roads", package, path, crs="EPSG:4979", overwrite=True)


def test_errors_have_the_words_of_the_program(program: str, tmp_path: Path) -> None:
    with pytest.raises(corniche.UsageError, match="none.tif") as raised:
        corniche.build(tmp_path / "out.pmtiles", dem="none.tif")
    assert raised.value.exit_code == 2 and "\n" not in str(raised.value)
    with pytest.raises(corniche.UsageError, match="--max-eror"):
        corniche.plan(dem="none.tif", max_eror=2)
    with pytest.raises(corniche.UsageError, match="none.pmtiles"):
        corniche.info("none.pmtiles")
    with pytest.raises(corniche.UsageError, match="none.pmtiles"):
        corniche.verify("none.pmtiles")


def test_warnings_of_the_program_are_warnings(program: str, tmp_path: Path) -> None:
    with pytest.warns(corniche.CornicheWarning, match="nothing to resume") as warned:
        corniche.build(tmp_path / "out.pmtiles", **corniche.sample(), **COARSE, resume=True)
    assert all(Path(one.filename) == Path(__file__) for one in warned), "a warning points at the caller"


def test_no_program_is_told_with_the_way_out(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(corniche.ProgramError, match="there is no program /nowhere/corniche; install a wheel"):
        corniche.info("a.pmtiles", corniche="/nowhere/corniche")
    monkeypatch.setenv("CORNICHE", "/nowhere/else")
    with pytest.raises(corniche.ProgramError, match="/nowhere/else"):
        corniche.run("info", "a.pmtiles")


def test_the_package_has_the_version_of_the_program(program: str) -> None:
    from importlib.metadata import version

    assert corniche.version_of(program) == f"corniche {version('corniche')}"


def test_those_that_tell_progress_are_known(program: str) -> None:
    def tells(*words: str) -> bool:
        return "--json-progress" in subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True).stdout

    listed = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout.partition("Options:")[0]
    commands = set(re.findall(r"^  ([a-z]+)  ", listed, re.MULTILINE)) - {"help", "export"}
    assert "build" in commands
    assert {command for command in commands if tells(command)} == TELL_PROGRESS - {"export"}
    assert tells("export", "roads") and tells("export", "geotiff")


def test_options_of_several_numbers_are_known(program: str) -> None:
    """Options that the program accepts once, as numbers with commas."""

    def told(*words: str) -> set[str]:
        help = subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True).stdout
        return {name.replace("-", "_") for name in re.findall(r"--([a-z-]+) <(?:LIST|[A-Z|]+(?:,[A-Z]+)+(?:\|[a-z]+)?)>", help)}

    found = set().union(*(told(command) for command in ("build", "plan", "match", "tile", "render", "view")), told("export", "roads"))
    assert found == ONE_VALUE


def test_what_the_functions_set_themselves_is_refused_by_name(package: Path, tmp_path: Path) -> None:
    output = tmp_path / "out.pmtiles"
    for option in ("quiet", "verbose", "json_progress", "log_format", "die_with_parent"):
        with pytest.raises(corniche.UsageError, match=f"{option}=.* is not available in Python"):
            corniche.build(output, **corniche.sample(), **{option: True})
    with pytest.raises(corniche.UsageError, match="json=False is not available in Python"):
        corniche.plan(**corniche.sample(), json=False)
    with pytest.raises(corniche.UsageError, match="json="):
        corniche.verify(package, json=True)
    with pytest.raises(corniche.UsageError, match="log_format="):
        corniche.serve(package, log_format="text")
    assert list(tmp_path.iterdir()) == []
    # Commands without progress accept the option, and an option that is off is omitted.
    assert corniche.run("info", package, json=True, quiet=True)
    assert corniche.verify(package, quiet=False)["holds"]


def test_help_is_printed(program: str) -> None:
    assert "The package to write" in corniche.run("help", "build")
    assert "The package to write" in corniche.run("build", help=True)
    assert corniche.run("--version").startswith("corniche ")


def test_paths_may_begin_with_a_hyphen(package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    made = corniche.build("-x.pmtiles", **corniche.sample(), **COARSE)
    assert corniche.info(Path("-x.pmtiles")) == made
    assert corniche.verify("-x.pmtiles")["holds"]
    assert corniche.export("roads", "-x.pmtiles", "-x.csv") == Path("-x.csv")
    assert corniche.run("info", Path("-x.pmtiles"))
    assert {path.name for path in tmp_path.iterdir()} == {"-x.pmtiles", "-x.csv"}


def test_python_runs_the_program_as_a_module(program: str) -> None:
    ran = subprocess.run([sys.executable, "-m", "corniche", "--version"], capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines()[0] == corniche.version_of(program)


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_a_stopped_build_leaves_its_work_alone_and_can_go_on(error: type[BaseException], program: str, tmp_path: Path) -> None:
    """The stop button of a notebook sends the process a signal, which raises KeyboardInterrupt."""

    def stop(stage: Stage) -> None:
        if stage.stage == "tiles":
            raise error

    options: dict[str, Any] = {**corniche.sample(), "max_error": 0.25}
    begun = time.monotonic()
    with pytest.raises(error):
        corniche.build(tmp_path / "out.pmtiles", **options, progress=stop)
    assert time.monotonic() - begun < 30
    assert [path.name for path in tmp_path.iterdir()] == [".out.pmtiles.work"]
    with pytest.raises(corniche.UnfinishedBuild, match=r"\.out\.pmtiles\.work.*\(here: resume=True or overwrite=True\)"):
        corniche.build(tmp_path / "out.pmtiles", **options)
    with pytest.raises(corniche.UnfinishedBuild, match=r"another build.*\(here: overwrite=True\)"):
        corniche.build(tmp_path / "out.pmtiles", **{**options, "max_error": 20}, resume=True)
    again: dict[str, Any] = {"resume": True} if error is ValueError else {"max_error": 20, "overwrite": True}
    assert corniche.build(tmp_path / "out.pmtiles", **{**options, **again})["manifest"]
    assert [path.name for path in tmp_path.iterdir()] == ["out.pmtiles"]


def test_threads_may_run_it_at_once(package: Path) -> None:
    found: list[dict[str, object]] = []
    threads = [threading.Thread(target=lambda: found.append(corniche.info(package))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 4 and all(one == found[0] for one in found)
