"""Packages in a browser, or in a notebook."""

from __future__ import annotations

import atexit
from types import TracebackType
from typing import Any

from .child import Child
from .errors import CornicheError
from .options import word_of_path
from .program import Place
from .running import Listener, start

# : All running servers. A map in a notebook must stay visible even if no variable refers to its
# server any more.
_running: set[Serving] = set()


class Serving:
    """A web server with a page that shows packages. It ends with :meth:`close`, at the end of a ``with`` block, or with this process."""

    def __init__(self, child: Child, url: str) -> None:
        self._child = child
        #: The address of the page.
        self.url = url
        _running.add(self)

    def close(self) -> None:
        """Ends the server."""
        if self in _running:
            _running.remove(self)
            self._child.stop()
            self._child.wait()

    def __enter__(self) -> Serving:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<corniche serve at {self.url}>"

    def _repr_html_(self) -> str:
        """The map, as a notebook shows it."""
        return (
            f'<iframe src="{self.url}" width="100%" height="480" style="border: 0" allowfullscreen></iframe>'
            f'<p><a href="{self.url}" target="_blank">{self.url}</a></p>'
        )


def serve(*packages: Place, port: int = 0, corniche: Place | None = None, **options: Any) -> Serving:
    """Serves packages to a browser on this computer. As the last line of a notebook cell it shows the map in the notebook.

    :param port: the port of the server; 0 chooses a free one
    :param options: the options of ``corniche serve``: ``open=True`` opens a browser
    :raises CornicheError: with the message of the program
    """
    command = ["serve", *(word_of_path(package) for package in packages)]
    child = start(command, {"port": port, **options}, corniche)
    url = child.first_line()
    if url is None:
        listener = Listener()
        ended = child.wait(heard=listener.hear)
        raise listener.error_of(command, ended) or CornicheError("corniche serve ended at once")
    return Serving(child, url)


@atexit.register
def _close_all() -> None:
    for serving in list(_running):
        serving.close()
