"""The questions: one file for each, with its result, the text and JSON of that, and its options."""
