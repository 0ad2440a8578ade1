"""Call: one request of a page on its way, with the line back to the page."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from time import monotonic
from typing import Any, cast

from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import FormatError
from trihex.formats import Draft
from trihex.viewer.bundle import encode
from trihex.viewer.document import draft_of_document
from trihex.viewer.requests import Request

TICK = 0.1  # seconds between two frames of progress

Arrays = Mapping[str, NDArray[Any]]
Send = Callable[[bytes], None]


class CancelledError(Exception):
    """The page does not wait for the answer any more."""


class Call:
    """One request on its way: its arrays, and the line back to the page."""

    def __init__(self, arrays: Arrays, send: Send, is_cancelled: Callable[[], bool]) -> None:
        self.arrays = arrays
        self._send, self._is_cancelled = send, is_cancelled
        self._told = monotonic()

    def check(self) -> None:
        """Raise CancelledError if the page has gone."""
        if self._is_cancelled():
            raise CancelledError

    def part(self, header: dict[str, Any], arrays: Arrays) -> None:
        """Send some of the result."""
        self._send(encode({"kind": "part", **header}, arrays))

    def progress(self, stage: str) -> Callable[[int, int], None]:
        """Return a function that tells the page how far `stage` is, and stops the work if the page has gone."""

        def tell(done: int, total: int) -> None:
            self.check()
            if monotonic() - self._told >= TICK:
                self._told = monotonic()
                self.tell(stage, done, total)

        return tell

    def tell(self, stage: str, done: int, total: int) -> None:
        """Tell the page how far `stage` is, at once."""
        self._send(encode({"kind": "progress", "stage": stage, "done": int(done), "total": int(total)}))

    def draft(self, request: Request) -> Draft:
        """Return the document of the request."""
        if request.document is None:
            raise FormatError(f"{request.op}: the document is missing")
        return draft_of_document(request.document, cast(dict[str, NDArray[Any]], self.arrays))

    def scenario(self, request: Request) -> Scenario:
        """Return the document of the request as a scenario."""
        return self.draft(request).complete()
