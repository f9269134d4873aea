"""Progress bars of tqdm for a command, in a notebook or on a terminal."""

from __future__ import annotations

import importlib.util
from typing import Any

from .errors import UsageError
from .records import Stage


class Bars:
    """A bar for each stage: ``corniche.build(…, progress=Bars())``, or ``progress=True``."""

    def __init__(self) -> None:
        self._tqdm = _tqdm()
        self._bar: Any = None

    def __call__(self, stage: Stage) -> None:
        """Shows the latest progress of the program."""
        if stage.state == "begin" or self._bar is None:
            self.close()
            is_bytes = stage.unit == "bytes"
            # Many stages take no time; a bar for each would fill the page.
            self._bar = self._tqdm(
                total=stage.total, initial=stage.done, desc=stage.title, unit="B" if is_bytes else f" {stage.unit}", unit_scale=is_bytes, leave=False
            )
        if stage.total is not None:
            self._bar.total = stage.total
        self._bar.update(stage.done - self._bar.n)
        if stage.state == "end":
            self.close()

    def close(self) -> None:
        """Closes the bar of the current stage."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None


def _tqdm() -> Any:
    if importlib.util.find_spec("tqdm") is None:
        raise UsageError("progress=True shows bars of tqdm, which is not installed: pip install tqdm, or pass a function")
    # Without ipywidgets a notebook would show a warning instead of a bar.
    if importlib.util.find_spec("ipywidgets") is None:
        from tqdm import tqdm
    else:
        from tqdm.auto import tqdm
    return tqdm
