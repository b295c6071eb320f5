"""The web application: its routes, and the protection against requests of other users and sites.

An address is ``/TOKEN/...``. A request without the token, with another host, or from another site, is refused
before anything else of it is read. No address is a path of a file.
"""

import asyncio
import contextlib
import hmac
import re
from collections.abc import AsyncIterator, Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, PlainTextResponse, Response, StreamingResponse
from starlette.routing import Route

from foon_asp.daemon_thread import DaemonThread
from foon_asp.deadline import Cancel
from foon_asp.errors import UserError
from foon_asp.json_layout import Json, json_line
from foon_asp.pictures.page import digest, script_json, web_text
from foon_asp.serve.desk import Desk, SendEvent
from foon_asp.serve.form import Form, RegretForm, read_question

Asgi = Callable[[Any, Any, Any], Any]

_PAGE_NUMBER = re.compile("[0-9]{1,18}")  # ``int`` raises for thousands of digits
_WEB = Path(__file__).resolve().parent / "web"
_HEADERS = {
    "content-security-policy": "default-src 'none'; frame-ancestors 'none'",
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",  # the address has the token
    "cache-control": "no-store",
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
}


def web_application(desk: Desk, token: str, port: int) -> Asgi:
    """Return the web application of a desk.

    It answers requests that have the token and come from a page of this machine at ``port``. It refuses all
    others.
    """

    def open_page(_: Request) -> Response:
        """Return the page with the opening form."""
        page, policy = _question_page(desk.opening_data())
        return HTMLResponse(page, headers={"content-security-policy": policy})

    def show_page(request: Request) -> Response:
        """Return the page with the number in the address; status 404 if it is no longer kept."""
        number = request.path_params["number"]
        page = desk.page(int(number)) if _PAGE_NUMBER.fullmatch(number) else None
        if page is None:
            return PlainTextResponse("this page is no longer kept: ask again", 404)
        return HTMLResponse(page, headers={"content-security-policy": "frame-ancestors 'self'"})

    def list_names(request: Request) -> Response:
        """Return up to 30 names that begin with the text in the query, as JSON."""
        return JSONResponse(desk.names_beginning(request.query_params.get("start", "")))

    async def ask_question(request: Request) -> Response:
        """Answer the form in the body, as a stream of events."""
        return await _stream_events(
            request, desk, lambda body: partial(desk.answer_form, read_question(body, Form))
        )

    async def ask_regret(request: Request) -> Response:
        """Answer the regret form in the body, as a stream of events."""
        return await _stream_events(
            request, desk, lambda body: partial(desk.answer_regret, read_question(body, RegretForm))
        )

    async def cancel_question(_: Request) -> Response:
        """Cancel the current question."""
        desk.cancel()
        return Response(status_code=204)

    routes = [
        Route(f"/{token}/", open_page),
        Route(f"/{token}/page/{{number}}", show_page),
        Route(f"/{token}/names", list_names),
        Route(f"/{token}/ask", ask_question, methods=["POST"]),
        Route(f"/{token}/without", ask_regret, methods=["POST"]),
        Route(f"/{token}/cancel", cancel_question, methods=["POST"]),
    ]
    return _guard(Starlette(routes=routes), token, f"127.0.0.1:{port}")


def _guard(app: Asgi, token: str, host: str) -> Asgi:
    """Return the application with protection: it refuses unauthorized requests, and adds security headers.

    An authorized request names the ``token`` and the ``host``. Connections that are not HTTP are ignored.
    """

    async def answer_or_refuse(scope: Any, receive: Any, send: Any) -> None:
        """Answer a request by ``app`` if it is authorized, otherwise by a refusal. Both get security headers.

        Ignore connections that are not HTTP.
        """
        if scope["type"] != "http":
            return

        async def send_with_headers(message: Any) -> None:
            """Send a message of the response; add the security headers that it lacks."""
            if message["type"] == "http.response.start":
                present = {name.lower() for name, _ in message["headers"]}
                defaults = [(name.encode(), value.encode()) for name, value in _HEADERS.items()]
                missing = [header for header in defaults if header[0] not in present]
                message["headers"] = [*message["headers"], *missing]
            await send(message)

        headers: dict[str, list[str]] = {}
        for name, value in scope["headers"]:
            headers.setdefault(name.decode("latin-1").lower(), []).append(value.decode("latin-1"))
        status = _refusal_status(scope["method"], scope["path"], headers, token, host)
        refusal = PlainTextResponse("refused", status or 200, {"connection": "close"})
        await (app if status is None else refusal)(scope, receive, send_with_headers)

    return answer_or_refuse


def _refusal_status(
    method: str, path: str, headers: Mapping[str, list[str]], token: str, host: str
) -> int | None:
    """Return the HTTP status with which a request is refused; ``None`` for an authorized one.

    It is 421 for another host, 403 for a request from another site, and 404 without the token. It is also 403
    for a POST that does not name its site, or whose body is not JSON. ``headers`` are lists of values by
    names in small letters.
    """
    if headers.get("host") != [host]:
        return 421
    origins = headers.get("origin", [])
    if any(origin != f"http://{host}" for origin in origins):
        return 403
    if not hmac.compare_digest(path[1 : len(token) + 2].encode(), f"{token}/".encode()):
        return 404
    if method == "POST" and not (origins and headers.get("content-type") == ["application/json"]):
        return 403
    return None


async def _stream_events(
    request: Request, desk: Desk, read: Callable[[bytes], Callable[[Cancel, SendEvent], None]]
) -> Response:
    """Return the events of a question as a stream of JSON Lines.

    ``read`` gets the body of the request, and returns the function that answers the question. Before the
    question begins, the current one is cancelled. The question runs in a thread, and is cancelled when the
    connection is closed.

    A body of more than 1,000,000 bytes is answered with status 413. A body that is no question is answered
    with status 400.
    """
    body = b""
    async for chunk in request.stream():
        body += chunk
        if len(body) > 1_000_000:  # before it fills the memory
            return PlainTextResponse("this question is too long", 413)
    try:
        answer = read(body)
    except UserError as error:
        return PlainTextResponse(str(error), 400)

    token = desk.next_token()  # before the response: once it has begun, the browser may cancel the question

    async def lines() -> AsyncIterator[str]:
        """Start the question, and yield a line for each of its events until it ends."""
        loop, queue = asyncio.get_running_loop(), asyncio.Queue[Json | None]()

        def send_event(event: Json | None) -> None:
            """Put an event into the queue from the thread of the question; ``None`` ends the stream."""
            with contextlib.suppress(RuntimeError):  # the server has ended
                loop.call_soon_threadsafe(queue.put_nowait, event)

        def run() -> None:
            """Answer the question, and end the stream."""
            try:
                answer(token, send_event)
            finally:
                send_event(None)

        DaemonThread(run)
        try:
            while (event := await queue.get()) is not None:
                yield json_line(event) + "\n"
        finally:
            token.cancel()

    return StreamingResponse(lines(), media_type="application/x-ndjson")


def _question_page(data: Json) -> tuple[str, str]:
    """Return the HTML of the page that asks questions, and its content security policy."""
    style = "\n".join(
        [
            web_text("colours_light.css"),
            web_text("colours_dark.css"),
            web_text("page.css"),
            web_text("ask.css", _WEB),
        ]
    )
    script = '"use strict";\n(() => {\n' + web_text("element.js") + web_text("ask.js", _WEB) + "})();\n"
    page = web_text("ask.html", _WEB).format(style=style, script=script, data=script_json(data))
    policy = (
        f"default-src 'none'; script-src {digest(script)}; style-src {digest(style)}; connect-src 'self'; "
        "frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
    return page, policy
