"""What can be asked: one file for each question, with what is found, how it is said, and its options."""
