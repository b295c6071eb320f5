"""A page on this machine that asks again: what is asked of it, how it answers, and who may ask."""
