"""FOON text in an editor: a language server. Only ``server.py`` and ``answers.py`` know its library."""
