"""Transcripts of the command line, which a person reads in a diff."""
