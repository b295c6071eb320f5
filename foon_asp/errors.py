"""The two kinds of failure: the user's, with advice, and ours, with an apology. And warnings."""


class UserError(Exception):
    """Something in the input cannot be used; the message says what, and often what to do.

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
    """Something in the data or in a constraint that the user should know, but that stops nothing.

    Example:
        >>> import warnings
        >>> with warnings.catch_warnings(record=True) as caught:
        ...     warnings.simplefilter("always")
        ...     foon = foon_asp.load("data/kitchen/FOON.txt")
        >>> caught[0].category.__name__
        'FoonWarning'
    """
