"""JSON, version 1: what every document is made of, and the schemas that say it."""
