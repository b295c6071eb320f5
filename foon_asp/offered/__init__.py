"""Searches and engines of other packages: found by entry points, and run in processes of their own."""
