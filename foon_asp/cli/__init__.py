"""The command line, the only part that prints."""

import gc

# Modules and networks are many small objects that stay to the end: looking for garbage among them finds none.
gc.set_threshold(100_000, 50, 50)
