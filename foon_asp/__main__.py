"""``python -m foon_asp``."""

from foon_asp.cli.main import main

main()
