"""JSON-RPC 2.0 with a Content-Length before each message, by which language servers communicate."""

import contextlib
from enum import IntEnum
from typing import Any, BinaryIO, TypeVar

from foon_asp.json_layout import Json, json_line, read_json

Value = TypeVar("Value")


class ErrorCode(IntEnum):
    """The reason why a request has no result; the numbers are those of the protocol."""

    INVALID_REQUEST = -32600
    METHOD_NOT_FOUND = -32601
    INVALID_PARAMETERS = -32602
    INTERNAL_ERROR = -32603
    CONTENT_MODIFIED = -32801
    """The text has changed since the request."""


class RequestError(Exception):
    """A refused request, with an error code and the reason."""

    def __init__(self, code: ErrorCode, message: str) -> None:
        super().__init__(message)
        self.code = code


def read_message(stream: BinaryIO) -> Json | None:
    """Read the next message from a stream, and wait for it.

    Return ``{}`` for a message that is no JSON object. Return ``None`` at the end of the stream. Also return
    ``None`` for a message whose length is 0 or no number, since its end is not known.
    """
    length = 0
    while (line := stream.readline()).strip():
        name, _, value = line.partition(b":")
        if name.lower() == b"content-length":
            length = int(value) if value.strip().isdigit() else 0
    text = stream.read(length)
    with contextlib.suppress(ValueError):
        message = read_json(text)
        return message if isinstance(message, dict) else {}
    return {} if text else None


def write_message(stream: BinaryIO, message: Json) -> None:
    """Write a message to a stream; does nothing if the reader of the stream has closed it."""
    body = json_line({"jsonrpc": "2.0", **message}).encode()
    with contextlib.suppress(BrokenPipeError):
        stream.write(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))
        stream.flush()


def parameter(parameters: object, path: str, kind: type[Value]) -> Value:
    """Return the value at a path of keys, such as ``position.line``, in the parameters of a request.

    Raises :class:`RequestError` if the value is missing, of another type than ``kind``, or a negative number.
    """
    value: Any = parameters
    for key in path.split("."):
        value = value.get(key) if isinstance(value, dict) else None
    if type(value) is not kind or (isinstance(value, int) and value < 0):
        raise RequestError(
            ErrorCode.INVALID_PARAMETERS, f"found {value!r:.40}, expected {kind.__name__} as {path}"
        )
    return value
