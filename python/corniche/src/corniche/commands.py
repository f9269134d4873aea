"""The commands that build and inspect packages."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, cast

from .errors import FAILED, CornicheError, PromiseBroken
from .options import word_of_path
from .program import Place
from .running import Progress, ran, refuse, run


def build(output: Place, *, progress: Progress = None, corniche: Place | None = None, **options: Any) -> dict[str, Any]:
    """Builds a tile package; returns the same document as :func:`info`.

    ``build("my.pmtiles", dem="dem.tif", osm="roads.osm.pbf", max_error=2.5, layers="areas")``

    :param output: the package to write; an existing one is overwritten only with ``overwrite=True``
    :param progress: a function that is called with a :class:`Stage` about twice a second; ``True`` shows bars of tqdm
    :param corniche: the path of the program; ``None``: ``$CORNICHE``, the program in this package, or the one on ``PATH``
    :param options: the options of ``corniche build``, with ``_`` instead of ``-``
    :raises UnfinishedBuild: if an earlier build was stopped, and neither ``resume`` nor ``overwrite`` is given
    :raises CornicheError: with the message of the program
    """
    run("build", progress=progress, corniche=corniche, output=output, **options)
    return info(output, corniche=corniche)


def plan(*, output: Place | None = None, corniche: Place | None = None, **options: Any) -> dict[str, Any]:
    """Estimates a build: tiles, memory, disk space, seconds. With ``output``, also writes the plan to this file.

    :param options: the options of ``corniche plan``: ``dem``, ``osm``, ``max_error`` and so on
    :raises CornicheError: with the message of the program
    """
    refuse(options, {"json"})
    return _document(run("plan", corniche=corniche, output=output, json=True, **options))


def info(package: Place, *, corniche: Place | None = None) -> dict[str, Any]:
    """Returns the content of a package, and what became of its inputs.

    :raises CornicheError: with the message of the program
    """
    return _document(run("info", word_of_path(package), corniche=corniche, json=True))


def verify(package: Place, *, progress: Progress = None, corniche: Place | None = None, **options: Any) -> dict[str, Any]:
    """Verifies a package; returns the document with all checks.

    :param options: the options of ``corniche verify``: the inputs (``dem``, ``osm`` and so on) to compare the package with
    :raises PromiseBroken: if a check is broken; the exception has the document
    :raises CornicheError: if the package cannot be checked
    """
    refuse(options, {"json"})
    result = ran(("verify", word_of_path(package)), {"json": True, **options}, progress, corniche)
    # Broken checks are reported in the document. If verification itself failed, there is no
    # document.
    if result.exit_code == FAILED and result.stdout:
        document = _document(result.stdout)
        # `None` is a check that does not apply, or was not run.
        broken = [f"{check['id']} ({check['promise']})" for check in document["checks"] if check["holds"] is False]
        raise PromiseBroken(f"{os.fspath(package)} breaks {len(broken)} of its promises: {'; '.join(broken)}", document)
    return _document(result.printed())


def export(what: str, package: Place, output: Place, *, progress: Progress = None, corniche: Place | None = None, **options: Any) -> Path:
    """Exports the content of a package for other programs; returns the path of the output, for example for ``geopandas.read_file``.

    :param what: ``roads``, ``edges``, ``areas``, ``boundaries``, ``mesh``, ``geotiff``, ``3dtiles`` or ``quantized-mesh``
    :param output: the file or folder to write; an existing one is overwritten only with ``overwrite=True``
    :param options: the options of ``corniche export WHAT``
    :raises CornicheError: with the message of the program
    """
    run("export", what, word_of_path(package), progress=progress, corniche=corniche, output=output, **options)
    return Path(output)


def _document(printed: str) -> dict[str, Any]:
    try:
        return cast(dict[str, Any], json.loads(printed))
    except ValueError as error:
        raise CornicheError(f"the program printed no JSON document: {error}") from error
