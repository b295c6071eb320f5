"""The command line, the only part that prints."""

import gc

# Modules and networks are many small objects that live to the end. Collections with the default thresholds
# free none of them, and take as long as importing clingo for a network of some thousand units.
gc.set_threshold(
    500_000, 50, 50
)  # allocations until a collection, and collections until one of older objects
