"""Values of results, and what is made of their fields."""
