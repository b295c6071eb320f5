"""Numbers with their nouns."""


def counted(number: int, noun: str, form: str = "") -> str:
    """Return a number with its noun, which gets an ``s`` unless the number is 1: ``1 unit``, ``2 units``.

    ``form`` is a format specification of Python for the number: ``,`` makes ``1,000 units``.
    """
    return f"{number:{form}} {noun}" + ("" if number == 1 else "s")
