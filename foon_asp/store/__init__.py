"""A network on disk, of which a question reads only what it is about."""
