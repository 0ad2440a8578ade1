"""Launch: the viewer on this machine, in the browser of its user."""

from __future__ import annotations

import os
import webbrowser
from collections.abc import Callable

from trihex.areas import Area, Scenario
from trihex.errors import ArgumentError, check_whole
from trihex.formats import Draft
from trihex.plans import Plan
from trihex.running import Run
from trihex.viewer.desk import Desk
from trihex.viewer.folder import Folder
from trihex.viewer.server import make_viewing


def open_viewer(
    record: Area | Scenario | Plan | Run | Draft | None = None,
    *,
    folder: str | os.PathLike[str] = ".",
    port: int = 0,
    browser: bool = True,
    tell: Callable[[str], None] = lambda address: None,
) -> None:
    """Serve the viewer on the loopback address until it is interrupted.

    Parameters
    ----------
    record : Area, Scenario, Plan or Run, optional
        What is shown at first. Default: an area of rooms to play with.
    folder : path
        Files are opened and saved below this folder only.
    port : int
        0 takes a free one.
    browser : bool
        Whether to open it in the browser of the user.
    tell : callable
        Called with the address once it can be opened; whoever knows it can use the viewer.

    Raises
    ------
    MissingExtraError
        If the extra ``view`` is not installed.
    OSError
        If there is no such folder, or the port is taken.
    """
    check_whole("port", port, 0, 65535, ArgumentError)
    desk, first = Desk(Folder(folder)), None
    if record is not None and desk.can_show_at_once(record):
        first = desk.show(record)
    else:
        desk.first = record
    viewing = make_viewing(desk, first, port=port)
    tell(viewing.address)
    if browser:
        # It listens already: a browser that is faster than the server waits for it.
        webbrowser.open(viewing.address)
    viewing.run()
