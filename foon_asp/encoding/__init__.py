"""Input of clingo: facts and numbers of a problem, encodings and their checks, and one run of them."""
