"""Programs that clingo grounds and searches, in this process or in a worker that can be killed."""
