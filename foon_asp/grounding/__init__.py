"""Programs that clingo grounds and searches, here or in a process that can be ended."""
