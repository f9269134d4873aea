"""The commands that make and look at packages."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, cast

from .errors import FAILED, CornicheError, PromiseBroken
from .options import word_of_path
from .running import Progress, ran, refuse, run

Place = str | os.PathLike[str]


def build(output: Place, *, progress: Progress = None, corniche: Place | None = None, **options: Any) -> dict[str, Any]:
    """Builds a tile package; returns what :func:`info` tells of it.

    ``build("my.pmtiles", dem="dem.tif", osm="roads.osm.pbf", max_error=2.5, areas="default")``

    :param output: the package to write; one that exists is replaced only with ``overwrite=True``
    :param progress: is called with a :class:`Stage` about twice a second; ``True``: bars of tqdm
    :param corniche: the program; ``None``: the one of this package, or the one on ``PATH``
    :param options: the options of ``corniche build``, with ``_`` in place of ``-``
    :raises UnfinishedBuild: if an earlier build was stopped, and neither ``resume`` nor ``overwrite`` says what becomes of its work
    :raises CornicheError: with the program's own words
    """
    run("build", progress=progress, corniche=corniche, output=output, **options)
    return info(output, corniche=corniche)


def plan(*, output: Place | None = None, corniche: Place | None = None, **options: Any) -> dict[str, Any]:
    """What a build would make and take: tiles, memory, disk space, seconds. With ``output``, the plan is written to this file, too.

    :param options: the options of ``corniche plan``: ``dem``, ``osm``, ``max_error`` and so on
    :raises CornicheError: with the program's own words
    """
    refuse(options, {"json"})
    return _document(run("plan", corniche=corniche, output=output, json=True, **options))


def info(package: Place, *, corniche: Place | None = None) -> dict[str, Any]:
    """What a package holds, and what became of its inputs.

    :raises CornicheError: with the program's own words
    """
    return _document(run("info", word_of_path(package), corniche=corniche, json=True))


def verify(package: Place, *, progress: Progress = None, corniche: Place | None = None, **options: Any) -> dict[str, Any]:
    """Checks every promise that a package makes; returns what was checked.

    :param options: the options of ``corniche verify``: the inputs, ``dem``, ``osm`` and so on, to check against them, too
    :raises PromiseBroken: if a promise is broken; it has the document
    :raises CornicheError: if the package cannot be checked
    """
    refuse(options, {"json"})
    result = ran(("verify", word_of_path(package)), {"json": True, **options}, progress, corniche)
    # The document is the answer, and there is none where the check itself failed.
    if result.exit_code == FAILED and result.stdout:
        document = _document(result.stdout)
        # `None` is one that had no case, or was not made.
        broken = [f"{check['id']} ({check['promise']})" for check in document["checks"] if check["holds"] is False]
        raise PromiseBroken(f"{os.fspath(package)} breaks {len(broken)} of its promises: {'; '.join(broken)}", document)
    return _document(result.printed())


def export(what: str, package: Place, output: Place, *, progress: Progress = None, corniche: Place | None = None, **options: Any) -> Path:
    """Gives what a package holds to other programs; returns the path of what was written, for example for ``geopandas.read_file``.

    :param what: ``roads``, ``edges``, ``areas``, ``boundaries``, ``mesh``, ``geotiff``, ``3dtiles`` or ``quantized-mesh``
    :param output: the file or folder to write; one that exists is replaced only with ``overwrite=True``
    :param options: the options of ``corniche export WHAT``
    :raises CornicheError: with the program's own words
    """
    run("export", what, word_of_path(package), progress=progress, corniche=corniche, output=output, **options)
    return Path(output)


def _document(printed: str) -> dict[str, Any]:
    try:
        return cast(dict[str, Any], json.loads(printed))
    except ValueError as error:
        raise CornicheError(f"the program printed no JSON document: {error}") from error
