"""Packs the program into the wheel: the folder that ``scripts/release`` creates and ``CORNICHE_RELEASE`` names, and the sample data.

Without this folder the wheel is pure Python, and runs a program that is installed separately.

    corniche/released/bin/corniche       the program
    corniche/released/lib/…              its libraries and tables, which the program finds relative to itself
    corniche/released/share/corniche/…   licences
    corniche/sample/…                    an invented mountain pass
    NAME.data/scripts/corniche           the command on the path, which executes the program
    NAME.data/data/share/…               manual pages and completions
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

#: The environment variable that names the folder.
FOLDER = "CORNICHE_RELEASE"
# : The platform tag of the wheel. ``scripts/wheel`` replaces it with the one that auditwheel
# determines.
PLATFORM = "linux_x86_64"
#: Folders that shells and ``man`` search in the environment, not in the package.
SHARED = ("man", "bash-completion", "zsh", "fish")
SAMPLE = ("pass-dem.tif", "pass.osm.pbf")


class PackProgram(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the files to the wheel that hatchling packs."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called by hatchling before it packs."""
        named = os.environ.get(FOLDER)
        if version == "editable" or not named:
            return
        folder = Path(named).resolve()
        if not os.access(folder / "bin" / "corniche", os.X_OK):
            raise FileNotFoundError(f"{FOLDER}: {folder} has no program bin/corniche; create the folder with scripts/release")
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{PLATFORM}"
        packed: dict[str, str] = build_data["force_include"]
        for file in sorted(path for path in folder.rglob("*") if path.is_file()):
            inside = file.relative_to(folder)
            is_shared = inside.parts[0] == "share" and inside.parts[1] in SHARED
            where = build_data["shared_data"] if is_shared else packed
            where[str(file)] = str(inside) if is_shared else f"corniche/released/{inside}"
        sample = Path(self.root).parents[1] / "data-samples" / "pass"
        packed.update({str(sample / name): f"corniche/sample/{name}" for name in SAMPLE})
        build_data["shared_scripts"][str(Path(self.root) / "launcher.py")] = "corniche"
