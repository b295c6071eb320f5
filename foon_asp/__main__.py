"""Entry point of ``python -m foon_asp``."""

from foon_asp.cli.start import main

if __name__ == "__main__":  # worker processes import this module too
    main()
