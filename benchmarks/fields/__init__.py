"""Data of other fields as networks, and the programs of these fields."""
