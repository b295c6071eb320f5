"""What other packages offer, searches and engines: found by entry points, run in processes of their own."""
