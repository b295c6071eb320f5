"""The statements of files, and of rules that are in none, with their places."""

from collections.abc import Callable, Iterator

from clingo import Control, MessageCode
from clingo.ast import AST, ASTSequence, Location, ProgramBuilder, parse_files, parse_string

from foon_asp.grounding.stated import Loaded, Stated

_TEXT = "<string>"  # what clingo calls a text that it parses


def parse(rules: Loaded, add: Callable[[AST], None], logger: Callable[[MessageCode, str], None]) -> None:
    """Give each statement to ``add``; raises ``RuntimeError`` after messages, as clingo does."""
    if not isinstance(rules, Stated):
        parse_files([str(rules)], add, logger=logger)
        return
    place = rules.place

    def placed(statement: AST) -> None:
        _place(statement, place)
        add(statement)

    def told(code: MessageCode, message: str) -> None:
        logger(code, place + message.removeprefix(_TEXT) if message.startswith(_TEXT) else message)

    parse_string(rules.text, placed, logger=told)


def load(control: Control, rules: Stated, logger: Callable[[MessageCode, str], None]) -> None:
    """Add rules that are in no file to a program; messages about them have their place."""
    with ProgramBuilder(control) as builder:
        parse(rules, builder.add, logger)


def nodes(piece: AST) -> Iterator[AST]:
    """Return a piece of a rule and all that is within it."""
    yield piece
    for key in piece.child_keys:
        child = getattr(piece, key)
        for part in child if isinstance(child, ASTSequence) else [child]:
            if isinstance(part, AST):
                yield from nodes(part)


def _place(statement: AST, place: str) -> None:
    for node in nodes(statement):
        if "location" in node.keys():  # noqa: SIM118 (it is no mapping)
            begin, end = node.location
            node.location = Location(begin._replace(filename=place), end._replace(filename=place))
