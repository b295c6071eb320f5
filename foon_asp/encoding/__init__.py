"""What clingo is given: facts and numbers of a problem, encodings and their checks, and one run of them."""
