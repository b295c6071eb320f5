"""The tests of foon_asp.text: FOON text and the tables beside it."""
