"""The beginning of a process, which imports the command line: ctrl-C may come before that is done."""

import sys


def main() -> None:
    """Import the command line and run it."""
    try:
        from foon_asp.cli.main import main as run
    except KeyboardInterrupt:
        print("interrupted before there was an answer", file=sys.stderr)
        sys.exit(3)
    run()
