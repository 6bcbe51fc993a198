"""A student's machine: the folder of an assignment, predictions, checks, the submission."""
