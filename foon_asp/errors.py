"""The two kinds of failure: the user's, which carry advice, and ours, which carry an apology."""


class UserError(Exception):
    """Something the user gave cannot be used; the message says what and often what to do."""


class BugError(Exception):
    """A promise of this program did not hold; please report it with the message."""
