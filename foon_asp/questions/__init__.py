"""The questions: one module for each, with its result type, text, JSON and options."""
