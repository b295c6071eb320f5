"""Parser of rules, in files or given as text, that keeps the places of statements."""

from collections.abc import Callable, Iterator

from clingo import Control, MessageCode
from clingo.ast import AST, ASTSequence, Location, ProgramBuilder, parse_files, parse_string

from foon_asp.encoding.stated import Loaded, Stated

_TEXT = "<string>"  # the file name that clingo uses for a text


def parse(rules: Loaded, add: Callable[[AST], None], logger: Callable[[MessageCode, str], None]) -> None:
    """Parse rules, and call ``add`` with each statement.

    For rules without a file, their name replaces the file name in statements and messages. ``logger`` gets
    clingo's messages. Raises ``RuntimeError`` for a syntax error, as clingo does.
    """
    if not isinstance(rules, Stated):
        parse_files([str(rules)], add, logger=logger)
        return
    place = rules.place

    def add_placed(statement: AST) -> None:
        """Set the name of the rules as file name in a statement, and add the statement."""
        _replace_file_name(statement, place)
        add(statement)

    def log_placed(code: MessageCode, message: str) -> None:
        """Put the name of the rules as file name into a message, and log the message."""
        logger(code, place + message.removeprefix(_TEXT) if message.startswith(_TEXT) else message)

    parse_string(rules.text, add_placed, logger=log_placed)


def load(control: Control, rules: Stated, logger: Callable[[MessageCode, str], None]) -> None:
    """Add rules that are in no file to a program.

    In clingo's messages about the rules, their name stands for a file name.
    """
    with ProgramBuilder(control) as builder:
        parse(rules, builder.add, logger)


def nodes(root: AST) -> Iterator[AST]:
    """Yield a node of the syntax tree and all its descendants, each before its children."""
    yield root
    for key in root.child_keys:
        child = getattr(root, key)
        for node in child if isinstance(child, ASTSequence) else [child]:
            if isinstance(node, AST):
                yield from nodes(node)


def _replace_file_name(statement: AST, place: str) -> None:
    """Replace, in place, the file name in the locations of a statement and its nodes by ``place``."""
    for node in nodes(statement):
        if "location" in node.keys():  # noqa: SIM118 (it is no mapping)
            begin, end = node.location
            node.location = Location(begin._replace(filename=place), end._replace(filename=place))
