"""FOON text in an editor: a language server."""
