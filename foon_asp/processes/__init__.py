"""Child processes of this program, which never outlive it: pipes, workers and pools."""
