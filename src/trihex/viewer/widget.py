"""Widget: the viewer in a notebook."""

from __future__ import annotations

import threading
from functools import cache
from typing import Any

from trihex.areas import Area, Scenario
from trihex.errors import MissingExtraError
from trihex.formats import Draft
from trihex.plans import Plan
from trihex.running import Run
from trihex.viewer.bundle import encode
from trihex.viewer.choices import choices
from trihex.viewer.desk import Desk
from trihex.viewer.page import settings_of
from trihex.viewer.script import module, source_of


def make_widget(record: Area | Scenario | Plan | Run | Draft | None = None, *, height: int = 720) -> Any:
    """Return the viewer as a widget for Jupyter and other notebooks.

    What is drawn and planned there can be had back in Python: ``widget.scenario`` and ``widget.plan`` are those of the
    last plan that was made or shown, ``widget.run`` is the last live run; None before.

    Parameters
    ----------
    record : Area, Scenario, Plan or Run, optional
        What is shown at first. Default: an area of rooms to play with.
    height : int
        In pixels.

    Raises
    ------
    MissingExtraError
        If the extra ``notebook`` is not installed.
    """
    return _widget_class()(record, height)


@cache
def _widget_class() -> Any:
    try:
        import anywidget
        import traitlets
    except ImportError:
        raise MissingExtraError("the viewer in a notebook needs anywidget: pip install 'trihex[notebook]'") from None

    class Viewer(anywidget.AnyWidget):
        """The viewer: traits tell the page what to show first, messages ask the desk."""

        _esm = module()
        _css = source_of("viewer.css")
        _settings = traitlets.Dict().tag(sync=True)
        _first = traitlets.Bytes(b"").tag(sync=True)
        height = traitlets.Int(720).tag(sync=True)

        def __init__(self, record: Area | Scenario | Plan | Run | Draft | None, height: int) -> None:
            self._desk = Desk()
            self._cancelled: dict[str, threading.Event] = {}
            first = b"" if record is None else encode(*self._desk.show(record))
            super().__init__(
                _settings=settings_of(host="notebook", folder=False, **choices()), _first=first, height=height
            )
            self.on_msg(_answer)

        @property
        def plan(self) -> Plan | None:
            """The last plan that was made or shown."""
            return self._desk.last_plan

        @property
        def scenario(self) -> Scenario | None:
            """The scenario of the last plan."""
            return None if self.plan is None else self.plan.scenario

        @property
        def run(self) -> Run | None:
            """What has happened so far in the last live run."""
            return self._desk.last_run

    return Viewer


def _answer(widget: Any, message: Any, buffers: list[Any]) -> None:
    """Answer a message in a thread of its own, so that the notebook goes on and the work can be cancelled."""
    name = str(message.get("id"))
    if message.get("cancel"):
        if name in widget._cancelled:
            widget._cancelled[name].set()
        return
    if len(buffers) != 1:
        return
    request, event = bytes(buffers[0]), threading.Event()
    widget._cancelled[name] = event

    def work() -> None:
        widget._desk.answer(request, lambda frame: widget.send({"id": name}, buffers=[frame]), event.is_set)
        del widget._cancelled[name]

    threading.Thread(target=work, daemon=True).start()
