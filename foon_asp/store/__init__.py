"""Stores: networks on disk; a question reads only the part of a network that it needs."""
