"""Rules of the user: constraints and measures, and what they do to the trees of a question."""
