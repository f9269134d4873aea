"""The program ``corniche``: where it is, and which version it is."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from .errors import ProgramError

#: A path as text or as an object.
Place = str | os.PathLike[str]
#: The environment variable that names the program, if the caller does not.
VARIABLE = "CORNICHE"
#: The program in platform wheels, next to the libraries and data that it needs.
PACKED = Path(__file__).with_name("released") / "bin" / "corniche"


def find_program(asked: Place | None = None) -> str:
    """The path of the program on this machine: the requested one, else ``$CORNICHE``, the program in this package, or the first on ``PATH``."""
    wanted = asked or os.environ.get(VARIABLE) or (PACKED if PACKED.is_file() else "corniche")
    found = shutil.which(wanted)
    if found is None:
        raise ProgramError(
            f"there is no program {wanted}; install a wheel of corniche that contains it, put it on PATH, or set ${VARIABLE} to its path"
            + (" or pass --corniche" if asked else "")
        )
    return os.path.abspath(found)


def version_of(program: str) -> str:
    """The program's name and version as in plans: ``corniche 1.2.3``."""
    try:
        told = subprocess.run([program, "--version"], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise ProgramError(f"{program} does not print its version: {error}") from error
    if told.returncode != 0:
        raise ProgramError(f"{program} does not print its version: exit code {told.returncode}: {told.stderr.strip()}")
    # Further lines name libraries.
    return told.stdout.partition("\n")[0].strip()
