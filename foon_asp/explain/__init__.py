"""The questions around an answer: why there is none, what it would take, what clashes, what differs."""
