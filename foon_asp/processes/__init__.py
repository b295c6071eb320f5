"""Other processes of this program, which end with it at the latest."""
