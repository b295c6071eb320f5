"""Rules of the user: constraints and measures, and their effect on the trees of a question."""
