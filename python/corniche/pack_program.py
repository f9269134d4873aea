"""Packs the program into the wheel: a folder as ``scripts/release`` lays it out, which ``CORNICHE_RELEASE`` names, and the sample.

Without such a folder the wheel is pure Python, and runs a program that is installed otherwise.

    corniche/released/bin/corniche       the program
    corniche/released/lib/…              its libraries and tables, found from the program on
    corniche/released/share/corniche/…   licences
    corniche/sample/…                    a made-up mountain pass
    NAME.data/scripts/corniche           the command on the path, which becomes the program
    NAME.data/data/share/…               manual pages and completions
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

#: Names the folder.
FOLDER = "CORNICHE_RELEASE"
#: Names the platform of the wheel. ``scripts/wheel`` puts the one that auditwheel finds in its place.
PLATFORM = "linux_x86_64"
#: What shells and ``man`` look for in the environment, and not in the package.
SHARED = ("man", "bash-completion", "zsh", "fish")
SAMPLE = ("pass-dem.tif", "pass.osm.pbf")


class PackProgram(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the files to what hatchling packs."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called by hatchling before it packs."""
        named = os.environ.get(FOLDER)
        if version == "editable" or not named:
            return
        folder = Path(named).resolve()
        if not os.access(folder / "bin" / "corniche", os.X_OK):
            raise FileNotFoundError(f"{FOLDER}: {folder} has no program bin/corniche; scripts/release lays such a folder out")
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
