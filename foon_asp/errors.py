"""Errors in the input, bugs of foon-asp, and warnings."""


class UserError(Exception):
    """An error in the input; the message says what is wrong, and often what to do.

    Example:
        >>> foon_asp.load(level=4)
        Traceback (most recent call last):
        foon_asp.errors.UserError: found level=4, expected 1, 2 or 3
    """


class BugError(Exception):
    """A bug in foon-asp; please report it with the message.

    Example:
        >>> issubclass(foon_asp.BugError, foon_asp.UserError)
        False
    """


class FoonWarning(UserWarning):
    """A warning about data or a constraint that the program uses nevertheless.

    Example:
        >>> import warnings
        >>> with warnings.catch_warnings(record=True) as caught:
        ...     warnings.simplefilter("always")
        ...     foon = foon_asp.load("data/kitchen/FOON.txt")
        >>> caught[0].category.__name__
        'FoonWarning'
    """
