"""What answers are made of: values with names, written as JSON, tables and text, each in one way."""
