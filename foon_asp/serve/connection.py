"""Connections of browsers, with limits on their number and on the time that they wait for a request."""

import asyncio
from typing import Any, ClassVar

from uvicorn.protocols.http.h11_impl import H11Protocol


class Connection(H11Protocol):  # type: ignore[misc]
    """A connection that closes if no complete request arrives in time.

    If more than ``max_waiting`` connections wait, the one that waits longest is closed. So the owner is not
    locked out by a program that opens connections and sends nothing, or half of a request.

    ``request_seconds``: the time limit for a request to arrive completely; with fewer, slow browsers are
    refused.
    ``max_waiting``: the greatest number of connections that wait at once; a browser has six.
    ``waiting_since``: the time when the wait began, in seconds of the event loop.
    """

    request_seconds: ClassVar[float] = 10.0
    max_waiting: ClassVar[int] = 64

    waiting_since = 0.0
    _timer: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Wait for the first request. If too many connections wait, close the one that waits longest."""
        super().connection_made(transport)
        self._start_timer()
        connections = (other for other in self.connections if isinstance(other, Connection))
        waiting = [connection for connection in connections if connection.waits]
        if len(waiting) > self.max_waiting:
            min(waiting, key=lambda connection: connection.waiting_since).abort()

    def data_received(self, data: bytes) -> None:
        """Receive a part of a request; stop the timer once the request is complete."""
        super().data_received(data)
        if not self.waits:
            self._stop_timer()

    def on_response_complete(self) -> None:
        """Wait for the next request, if the connection stays open."""
        super().on_response_complete()
        if self.waits:
            self._start_timer()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop the timer once the connection is closed."""
        self._stop_timer()
        super().connection_lost(exc)

    @property
    def waits(self) -> bool:
        """Whether the connection waits for a request, or for the rest of one.

        It does not wait while a complete request is answered, nor when it is closing.
        """
        cycle = self.cycle
        return not self.transport.is_closing() and (
            cycle is None or cycle.response_complete or cycle.more_body
        )

    def abort(self) -> None:
        """Close the connection at once."""
        self._stop_timer()
        self.transport.abort()

    def _start_timer(self) -> None:
        """Begin to wait: the connection closes after ``request_seconds``, unless the timer is stopped."""
        self._stop_timer()
        self.waiting_since = self.loop.time()
        self._timer = self.loop.call_later(self.request_seconds, self.abort)

    def _stop_timer(self) -> None:
        """Stop the timer, if it is running."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
