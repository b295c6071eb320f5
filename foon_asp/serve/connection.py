"""A connection of a browser, on which a request is waited for with patience, but not for ever."""

import asyncio
from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol

_PATIENCE = 10.0  # seconds for a request to come as a whole
_MOST = 64  # connections that may wait for a request at once; a browser has six


class Connection(H11Protocol):  # type: ignore[misc]
    """Closes itself when no whole request comes in time, and when too many others wait that came later.

    So nobody who opens connections and says nothing, or half of a request, keeps the owner out.
    """

    since = 0.0
    _timer: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Wait for the first request; of too many that wait, the one that has waited longest is closed."""
        super().connection_made(transport)
        self._wait()
        waiting = [each for each in self.connections if isinstance(each, Connection) and each.waits]
        if len(waiting) > _MOST:
            min(waiting, key=lambda each: each.since).end()

    def data_received(self, data: bytes) -> None:
        """Take a part of a request, which may be the last."""
        super().data_received(data)
        if not self.waits:
            self._stop()

    def on_response_complete(self) -> None:
        """Wait for the next request."""
        super().on_response_complete()
        if self.waits:
            self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait no more."""
        self._stop()
        super().connection_lost(exc)

    @property
    def waits(self) -> bool:
        """Whether a request, or the rest of one, has to come before there is anything to do."""
        asked = self.cycle
        return not self.transport.is_closing() and (
            asked is None or asked.response_complete or asked.more_body
        )

    def end(self) -> None:
        """Close the connection at once."""
        self._stop()
        self.transport.abort()

    def _wait(self) -> None:
        self._stop()
        self.since = self.loop.time()
        self._timer = self.loop.call_later(_PATIENCE, self.end)

    def _stop(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
