"""A local web page that asks questions interactively: its server, its requests and its protection."""
