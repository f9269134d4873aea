"""A served package has an address, and its server ends with the process that shows it."""

from __future__ import annotations

import subprocess
import sys
import urllib.request
from pathlib import Path
from urllib.error import URLError

import pytest

import corniche


@pytest.fixture
def page(tmp_path: Path) -> Path:
    """A folder that replaces the page, for a program that was built without it."""
    folder = tmp_path / "page"
    folder.mkdir()
    (folder / "index.html").write_text("<!doctype html><title>Maps</title>")
    return folder


def get(url: str) -> bytes:
    # Proxies of the environment must not be used for this computer.
    with urllib.request.build_opener(urllib.request.ProxyHandler({})).open(url, timeout=20) as answer:
        return bytes(answer.read())


def test_a_package_is_served_until_it_is_closed(package: Path, page: Path) -> None:
    with corniche.serve(package, page=page) as serving:
        assert b"Maps" in get(serving.url)
        assert get(f"{serving.url}packages/pass.pmtiles") == package.read_bytes()
        assert f'src="{serving.url}"' in serving._repr_html_()
    with pytest.raises(URLError):
        get(serving.url)
    serving.close()


def test_what_cannot_be_served_is_told(program: str, page: Path) -> None:
    with pytest.raises(corniche.UsageError, match="none.pmtiles"):
        corniche.serve("none.pmtiles", page=page)


@pytest.mark.parametrize("end", ["", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"])
def test_it_ends_with_the_process_that_began_it(end: str, package: Path, page: Path) -> None:
    """Also if the process is killed, like the kernel of a notebook."""
    code = f"import corniche; print(corniche.serve({str(package)!r}, page={str(page)!r}).url, flush=True); {end}"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    url = ran.stdout.strip()
    assert url.startswith("http://127.0.0.1:"), ran.stderr
    for _ in range(100):
        try:
            get(url)
        except OSError:
            return
    raise AssertionError("it serves on")
