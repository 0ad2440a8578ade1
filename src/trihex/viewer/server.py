"""Server: the viewer on the loopback address, for the one who started it and nobody else.

The address holds a token that only the terminal shows. Beside it, Host and Origin are checked, so that neither a page
of another origin nor a name that was rebound to 127.0.0.1 gets through; sizes are bounded before anything is read.
"""

from __future__ import annotations

import asyncio
import contextlib
import queue
import socket
import threading
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass
from secrets import compare_digest, token_urlsafe
from struct import pack
from typing import TYPE_CHECKING, Any

from trihex.errors import MissingExtraError
from trihex.viewer.bundle import Bundle
from trihex.viewer.choices import choices
from trihex.viewer.desk import Desk
from trihex.viewer.page import page_with, settings_of
from trihex.viewer.script import module

if TYPE_CHECKING:
    from starlette.requests import Request
    from starlette.responses import Response
    from starlette.routing import Router

LOOPBACK = "127.0.0.1"
MAX_BODY = 2**26  # bytes of a request: 16 million cells and two million robots take 10 MB
_MOST_JOBS = 8  # a page has three at most: a question, a step of a live run, and what is compiled beside them
_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Frame-Options": "DENY",
    "Cache-Control": "no-store",
}

Scope = dict[str, Any]
Receive = Callable[[], Any]
SendMessage = Callable[[Any], Any]


class RefusedError(Exception):
    """A request that is not answered, with its status and the reason."""

    def __init__(self, status: int, reason: str) -> None:
        super().__init__(reason)
        self.status, self.reason = status, reason


@dataclass
class Guard:
    """ASGI application around another that lets only requests of its own page through, and adds headers of safety.

    Parameters
    ----------
    app : ASGI application
    token : str
        First part of every path.
    hosts : set of str
        Host headers that are let through, such as ``127.0.0.1:8000``.
    """

    app: Any
    token: str
    hosts: frozenset[str]

    async def __call__(self, scope: Scope, receive: Receive, send: SendMessage) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] != "http":
            return
        size = 0

        async def counted() -> Any:
            nonlocal size
            message = await receive()
            size += len(message.get("body", b""))
            if size > MAX_BODY:
                raise RefusedError(413, f"a request may have at most {MAX_BODY} bytes")
            return message

        async def safe(message: Any) -> None:
            if message["type"] == "http.response.start":
                names = {name.lower() for name, _ in message["headers"]}
                extra = [(k.lower().encode(), v.encode()) for k, v in _HEADERS.items()]
                message["headers"] = [*message["headers"], *(pair for pair in extra if pair[0] not in names)]
            await send(message)

        try:
            self._check(scope)
            await self.app(scope, counted, safe)
        except RefusedError as refused:
            await _refuse(refused, safe)

    def _check(self, scope: Scope) -> None:
        headers: dict[str, list[str]] = {}
        for name, value in scope["headers"]:
            headers.setdefault(name.decode("latin-1").lower(), []).append(value.decode("latin-1"))
        host = headers.get("host", [])
        if len(host) != 1 or host[0].lower() not in self.hosts:
            raise RefusedError(421, "wrong Host")
        if any(origin != f"http://{host[0].lower()}" for origin in headers.get("origin", [])):
            raise RefusedError(403, "wrong Origin")
        if any(site not in ("same-origin", "none") for site in headers.get("sec-fetch-site", [])):
            raise RefusedError(403, "another site")
        if scope["method"] not in ("GET", "HEAD", "POST"):
            raise RefusedError(405, "wrong method")
        if scope["method"] == "POST" and "origin" not in headers:
            raise RefusedError(403, "a POST must have an Origin")
        token = scope["path"].split("/")[1] if scope["path"].startswith("/") else ""
        if not compare_digest(token.encode(), self.token.encode()):
            raise RefusedError(403, "wrong token: open the address that the terminal shows")
        length = headers.get("content-length", ["0"])[0]
        if not length.isascii() or not length.isdigit() or int(length[:20]) > MAX_BODY:
            raise RefusedError(413, f"a request may have at most {MAX_BODY} bytes")


async def _refuse(refused: RefusedError, send: SendMessage) -> None:
    body = refused.reason.encode()
    headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", str(len(body)).encode())]
    headers.append((b"connection", b"close"))
    await send({"type": "http.response.start", "status": refused.status, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def make_app(desk: Desk, first: Bundle | None, settings: dict[str, Any], token: str, port: int) -> Guard:
    """Return the ASGI application of the viewer.

    Raises
    ------
    MissingExtraError
        If the extra ``view`` is not installed.
    """
    routes = _routes(desk, first, settings, token)
    return Guard(routes, token, frozenset({f"{LOOPBACK}:{port}", f"localhost:{port}"}))


def _routes(desk: Desk, first: Bundle | None, settings: dict[str, Any], token: str) -> Router:
    try:
        from starlette.responses import HTMLResponse, Response, StreamingResponse
        from starlette.routing import Route, Router
    except ImportError:
        raise MissingExtraError("the viewer needs starlette and uvicorn: pip install 'trihex[view]'") from None
    html, policy = page_with(settings, first, "trihex", is_alone=False)
    jobs = asyncio.Semaphore(_MOST_JOBS)

    async def page(request: Request) -> Response:
        return HTMLResponse(html, headers={"Content-Security-Policy": f"{policy}; frame-ancestors 'none'"})

    async def script(request: Request) -> Response:
        return Response(module(), media_type="text/javascript")

    async def ask(request: Request) -> Response:
        body = await request.body()
        return StreamingResponse(_frames(desk, body, request, jobs), media_type="application/octet-stream")

    return Router(
        routes=[
            Route(f"/{token}/", page, methods=["GET"]),
            Route(f"/{token}/viewer.js", script, methods=["GET"]),
            Route(f"/{token}/ask", ask, methods=["POST"]),
        ]
    )


async def _frames(desk: Desk, body: bytes, request: Request, jobs: asyncio.Semaphore) -> AsyncIterator[bytes]:
    """Yield the frames of an answer, each after its length in 4 bytes; stop the work when the page has gone."""
    frames: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
    is_gone = threading.Event()

    def work() -> None:
        desk.answer(body, frames.put, is_gone.is_set)
        frames.put(None)

    async with jobs:
        thread = threading.Thread(target=work, daemon=True)
        thread.start()
        try:
            while (frame := await _next(frames, request)) is not None:
                yield pack("<I", len(frame))
                yield frame
        finally:
            is_gone.set()


async def _next(frames: queue.SimpleQueue[bytes | None], request: Request) -> bytes | None:
    """Return the next frame; None at the end, or once the page does not listen any more."""
    wait = 0.001
    while True:
        with contextlib.suppress(queue.Empty):
            return frames.get_nowait()
        if await request.is_disconnected():
            return None
        await asyncio.sleep(wait)
        wait = min(wait * 1.5, 0.05)


@dataclass
class Viewing:
    """A server that is ready to run: its address, and the socket that it will listen on."""

    address: str
    app: Guard
    listener: socket.socket

    def run(self) -> None:
        """Serve until the process is interrupted."""
        server = _server(self.app)
        server.run(sockets=[self.listener])

    @contextlib.contextmanager
    def running(self) -> Any:
        """Serve in a thread of its own while the block runs."""
        server = _server(self.app)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [self.listener]}, daemon=True)
        thread.start()
        try:
            yield self
        finally:
            server.should_exit = True
            thread.join(10)
            self.listener.close()


def _server(app: Guard) -> Any:
    try:
        import uvicorn
    except ImportError:
        raise MissingExtraError("the viewer needs starlette and uvicorn: pip install 'trihex[view]'") from None
    config = uvicorn.Config(
        app, log_level="warning", access_log=False, server_header=False, ws="none", lifespan="off", timeout_keep_alive=5
    )
    return uvicorn.Server(config)


def make_viewing(desk: Desk, first: Bundle | None = None, *, port: int = 0) -> Viewing:
    """Return a server for `desk` on a free port of the loopback address, with a token of its own.

    Raises
    ------
    MissingExtraError
        If the extra ``view`` is not installed.
    OSError
        If the port is taken.
    """
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.bind((LOOPBACK, port))
    listener.listen()
    port, token = listener.getsockname()[1], token_urlsafe(18)
    more = {"folder": desk.folder is not None, "first": desk.first is not None}
    app = make_app(desk, first, settings_of(host="server", **more, **choices()), token, port)
    return Viewing(f"http://{LOOPBACK}:{port}/{token}/", app, listener)
