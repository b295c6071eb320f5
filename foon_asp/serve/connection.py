"""Connections of browsers, with a limit on the time that they wait for a request, and on their number."""

import asyncio
from typing import Any, ClassVar

from uvicorn.protocols.http.h11_impl import H11Protocol


class Connection(H11Protocol):  # type: ignore[misc]
    """A connection that closes when no complete request arrives in time, and when too many wait.

    So no program that opens connections and sends nothing, or half of a request, locks the owner out.
    ``waiting_since`` is a time of the event loop, in seconds.

    ``request_seconds``: for a request to arrive completely; fewer refuse slow browsers.
    ``max_waiting``: connections that wait at once; a browser has six.
    """

    request_seconds: ClassVar[float] = 10.0
    max_waiting: ClassVar[int] = 64

    waiting_since = 0.0
    _timer: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Wait for the first request; of too many waiting connections, the longest waiting one is closed."""
        super().connection_made(transport)
        self._start_timer()
        connections = (other for other in self.connections if isinstance(other, Connection))
        waiting = [connection for connection in connections if connection.waits]
        if len(waiting) > self.max_waiting:
            min(waiting, key=lambda connection: connection.waiting_since).end()

    def data_received(self, data: bytes) -> None:
        """Receive a part of a request; a complete one stops the timer."""
        super().data_received(data)
        if not self.waits:
            self._stop_timer()

    def on_response_complete(self) -> None:
        """Wait for the next request."""
        super().on_response_complete()
        if self.waits:
            self._start_timer()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop the timer."""
        self._stop_timer()
        super().connection_lost(exc)

    @property
    def waits(self) -> bool:
        """Whether the connection waits for a request, or for more of one."""
        cycle = self.cycle
        return not self.transport.is_closing() and (
            cycle is None or cycle.response_complete or cycle.more_body
        )

    def end(self) -> None:
        """Close the connection at once."""
        self._stop_timer()
        self.transport.abort()

    def _start_timer(self) -> None:
        self._stop_timer()
        self.waiting_since = self.loop.time()
        self._timer = self.loop.call_later(self.request_seconds, self.end)

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
