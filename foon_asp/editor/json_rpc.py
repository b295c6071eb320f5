"""JSON-RPC 2.0 with a Content-Length before each message, the transport of language servers."""

import contextlib
from typing import Any, BinaryIO, TypeVar

from foon_asp.text.json_value import Json, json_line, read_json

INVALID_REQUEST, METHOD_NOT_FOUND, INVALID_PARAMETERS, INTERNAL_ERROR = -32600, -32601, -32602, -32603
CONTENT_MODIFIED = -32801

Value = TypeVar("Value")


class RequestError(Exception):
    """A request is refused; ``code`` is the error code of the protocol."""

    def __init__(self, code: int, message: str) -> None:
        super().__init__(message)
        self.code = code


def read_message(stream: BinaryIO) -> Json | None:
    """Return the next message; ``{}`` where it is no JSON object, ``None`` at the end of the stream."""
    length = 0
    while (line := stream.readline()).strip():
        name, _, value = line.partition(b":")
        if name.lower() == b"content-length":
            length = int(value)
    text = stream.read(length)
    with contextlib.suppress(ValueError):
        message = read_json(text)
        return message if isinstance(message, dict) else {}
    return {} if text else None


def write_message(stream: BinaryIO, message: Json) -> None:
    """Write a message; a stream that its reader has closed is ignored."""
    body = json_line({"jsonrpc": "2.0", **message}).encode()
    with contextlib.suppress(BrokenPipeError):
        stream.write(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))
        stream.flush()


def parameter(parameters: object, path: str, kind: type[Value]) -> Value:
    """Return the value at a path of keys, joined by dots, in the parameters of a request.

    Raises :class:`RequestError` for a value of another type, and for a negative number.
    """
    value: Any = parameters
    for key in path.split("."):
        value = value.get(key) if isinstance(value, dict) else None
    if type(value) is not kind or (isinstance(value, int) and value < 0):
        raise RequestError(INVALID_PARAMETERS, f"found {value!r:.40}, expected {kind.__name__} as {path}")
    return value
