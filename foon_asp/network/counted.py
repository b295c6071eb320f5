"""Numbers with their nouns."""


def counted(number: int, noun: str, form: str = "") -> str:
    """Return a number with its noun: ``1 unit``, ``2 units``; ``form`` is how to write it."""
    return f"{number:{form}} {noun}" + ("" if number == 1 else "s")
