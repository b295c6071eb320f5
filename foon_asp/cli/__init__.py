"""The command line, the only part that prints."""

import gc

# Modules and networks are many small objects that stay to the end: looking for garbage among them finds none,
# and takes as long as to import clingo where they are as many as those of a network of some thousand units.
gc.set_threshold(500_000, 50, 50)
