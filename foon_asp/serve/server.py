"""The web server. It listens on the loopback interface only, at an address with a secret token."""

import secrets
import socket
from collections.abc import Callable

import uvicorn

from foon_asp.serve.connection import Connection
from foon_asp.serve.desk import Desk
from foon_asp.serve.site import web_application


def serve_desk(desk: Desk, ready: Callable[[str], object]) -> None:
    """Serve the page of a desk until ctrl-C, and then cancel the current question and return.

    The address has a port that is free, and a new secret token. Before the server runs, ``ready`` is called
    with the address; connections are queued from then on.
    """
    token = secrets.token_urlsafe(24)
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen()
        port = listener.getsockname()[1]
        config = uvicorn.Config(
            web_application(desk, token, port),
            http=Connection,
            backlog=128,  # connections that may wait to be accepted
            access_log=False,  # it would have the token
            log_config=None,
            log_level="critical",
            lifespan="off",
            ws="none",
            proxy_headers=False,
            server_header=False,
            timeout_graceful_shutdown=1,
        )
        ready(f"http://127.0.0.1:{port}/{token}/")
        try:
            uvicorn.Server(config).run(sockets=[listener])
        except KeyboardInterrupt:
            pass
        finally:
            desk.cancel()
