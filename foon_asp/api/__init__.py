"""The same questions in Python: data loaded once, problems that vary, a function for each question."""
