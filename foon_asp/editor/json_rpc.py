"""JSON-RPC 2.0 with a Content-Length before each message, the transport of language servers."""

import contextlib
from enum import IntEnum
from typing import Any, BinaryIO, TypeVar

from foon_asp.text.json_value import Json, json_line, read_json

Value = TypeVar("Value")


class ErrorCode(IntEnum):
    """Why there is no result; the numbers are those of the protocol."""

    INVALID_REQUEST = -32600
    METHOD_NOT_FOUND = -32601
    INVALID_PARAMETERS = -32602
    INTERNAL_ERROR = -32603
    CONTENT_MODIFIED = -32801
    """The text has changed since the request."""


class RequestError(Exception):
    """A request is refused with an error code."""

    def __init__(self, code: ErrorCode, message: str) -> None:
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
        raise RequestError(
            ErrorCode.INVALID_PARAMETERS, f"found {value!r:.40}, expected {kind.__name__} as {path}"
        )
    return value
