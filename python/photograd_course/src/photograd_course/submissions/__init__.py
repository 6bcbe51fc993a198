"""Submissions judged: taken in, run, scored, reported; one of them or a whole course."""
