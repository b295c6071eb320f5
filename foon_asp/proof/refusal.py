"""The refusal of a certificate: its exceptions, and :func:`require`, which raises them."""

from collections.abc import Iterator
from contextlib import contextmanager


class RefusedError(Exception):
    """The certificate is wrong; the message says where.

    Example:
        >>> import pathlib, tempfile
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "proof.json"
        >>> _ = file.write_text("{}")
        >>> foon_asp.verify(foon_asp.load(), file)
        Traceback (most recent call last):
        foon_asp.proof.refusal.RefusedError: expected the format 'foon-asp certificate'
    """


class CheckLimitError(RefusedError):
    """The certificate may be right, but it exceeds a limit of :class:`CertificateLimits`."""


def require(holds: bool, otherwise: str) -> None:
    """Raise :class:`RefusedError` with the message ``otherwise`` unless ``holds`` is true."""
    if not holds:
        raise RefusedError(otherwise)


@contextmanager
def refuse_deep_nesting() -> Iterator[None]:
    """Raise :class:`RefusedError` in place of a ``RecursionError`` of the block or decorated function."""
    try:
        yield
    except RecursionError:
        raise RefusedError("branches nested too deeply") from None
