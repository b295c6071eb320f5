"""Entry point of the process: it handles ctrl-C before it imports the command line."""

from foon_asp.cli.early_exit import end_at_ctrl_c


def main() -> None:
    """Make ctrl-C exit the process at once, then import the command line and run it."""
    end_at_ctrl_c()
    from foon_asp.cli.main import main as run

    run()
