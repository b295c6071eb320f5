"""Tables, texts and JSON for what was found."""
