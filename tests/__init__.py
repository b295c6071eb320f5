"""The tests of foon-asp."""
