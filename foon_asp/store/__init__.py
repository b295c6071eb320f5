"""Stores: networks on disk, of which a question reads only the part that it needs."""
