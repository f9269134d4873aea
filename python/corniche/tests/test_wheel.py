"""A wheel with a program puts it on the path and uses it; a wheel without one says how to get it."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[1]
ROOT = PROJECT.parents[1]
pytestmark = pytest.mark.skipif(not (PROJECT / "pack_program.py").is_file(), reason="only in the repository")


def make_wheel(out: Path, release: Path | None) -> Path:
    environment = {name: value for name, value in os.environ.items() if name != "CORNICHE_RELEASE"}
    if release:
        environment["CORNICHE_RELEASE"] = str(release)
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--no-index", str(PROJECT), "-w", str(out)]
    subprocess.run(command, env=environment, check=True)
    (wheel,) = out.glob("*.whl")
    return wheel


@pytest.fixture(scope="module")
def packed(program: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel of a folder like that of scripts/release, with a stand-in that runs the program."""
    release = tmp_path_factory.mktemp("release")
    for path, text in {
        "bin/corniche": f'#!/bin/sh\nexec "{program}" "$@"\n',
        "lib/corniche/lib/libexample.so.1": "a library",
        "share/corniche/licences/EXAMPLE": "a licence",
        "share/man/man1/corniche.1": "a page",
        "share/zsh/site-functions/_corniche": "completions",
    }.items():
        file = release / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    (release / "bin/corniche").chmod(0o755)
    return make_wheel(tmp_path_factory.mktemp("wheel"), release)


def test_a_wheel_has_the_folder_the_sample_and_the_command(packed: Path) -> None:
    assert packed.name == "corniche-0.1.0-py3-none-linux_x86_64.whl"
    with zipfile.ZipFile(packed) as wheel:
        names = set(wheel.namelist())
        modes = {entry.filename: entry.external_attr >> 16 for entry in wheel.infolist()}
    data = "corniche-0.1.0.data"
    assert {
        "corniche/released/bin/corniche",
        "corniche/released/lib/corniche/lib/libexample.so.1",
        "corniche/released/share/corniche/licences/EXAMPLE",
        "corniche/sample/pass-dem.tif",
        "corniche/sample/pass.osm.pbf",
        f"{data}/scripts/corniche",
        f"{data}/data/share/man/man1/corniche.1",
        f"{data}/data/share/zsh/site-functions/_corniche",
    } <= names, names
    assert modes["corniche/released/bin/corniche"] & 0o111, "it can be executed"


def test_an_installed_wheel_needs_no_path_and_no_variables(packed: Path, tmp_path: Path) -> None:
    environment = tmp_path / "environment"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(environment)], check=True)
    install = [sys.executable, "-m", "pip", "--python", str(environment / "bin" / "python"), "install", "--quiet", "--no-index", "--no-deps"]
    subprocess.run([*install, str(packed)], check=True)
    bare = {"PATH": "/usr/bin:/bin", "HOME": str(tmp_path)}

    def said(*command: str) -> str:
        return subprocess.run(command, capture_output=True, text=True, env=bare, cwd=tmp_path, check=True).stdout

    assert said(str(environment / "bin" / "corniche"), "--version").startswith("corniche 0.1.0")
    code = "import corniche; print(corniche.build('a.pmtiles', **corniche.sample(), max_error=20)['manifest']['crs'], corniche.find_program())"
    crs, found = said(str(environment / "bin" / "python"), "-c", code).split()
    assert crs == "EPSG:32632" and Path(found).is_relative_to(environment)
    assert (environment / "share/man/man1/corniche.1").is_file()


def test_the_same_folder_makes_the_same_bytes(packed: Path, program: str, tmp_path: Path) -> None:
    with zipfile.ZipFile(packed) as wheel:
        names = [name for name in wheel.namelist() if name.startswith("corniche/released/")]
        release = tmp_path / "again"
        for name in names:
            file = release / name.removeprefix("corniche/released/")
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(wheel.read(name))
        for name in [name for name in wheel.namelist() if ".data/data/" in name]:
            file = release / name.partition(".data/data/")[2]
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(wheel.read(name))
    (release / "bin/corniche").chmod(0o755)
    assert make_wheel(tmp_path / "out", release).read_bytes() == packed.read_bytes()


def test_a_folder_without_a_program_is_refused(tmp_path: Path) -> None:
    with pytest.raises(subprocess.CalledProcessError):
        make_wheel(tmp_path / "out", tmp_path)


def test_without_a_folder_the_wheel_is_for_any_system(tmp_path: Path) -> None:
    wheel = make_wheel(tmp_path, None)
    assert wheel.name == "corniche-0.1.0-py3-none-any.whl"
    with zipfile.ZipFile(wheel) as files:
        assert not any("released" in name or "scripts" in name for name in files.namelist())
