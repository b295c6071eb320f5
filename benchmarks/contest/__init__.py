"""What the comparison of engines is made of: instances, trials, and one module for each engine."""
