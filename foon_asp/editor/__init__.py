"""A language server, which checks FOON text in an editor."""
