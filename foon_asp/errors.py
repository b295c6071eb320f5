"""The two kinds of failure: the user's, with advice, and ours, with an apology. And warnings."""


class UserError(Exception):
    """Something the user gave cannot be used; the message says what and often what to do."""


class BugError(Exception):
    """A promise of this program did not hold; please report it with the message."""


class FoonWarning(UserWarning):
    """Something in the data or in a constraint that the user should know about, and that stops nothing."""
