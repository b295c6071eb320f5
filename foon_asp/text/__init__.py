"""FOON text and the tables beside it, in and out."""
