"""Values and documents that answers consist of, written as JSON, tables and text."""
