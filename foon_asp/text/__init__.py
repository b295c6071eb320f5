"""Reading, writing and conversion of FOON as text and as JSON, and of the tables beside a network."""
