"""Submissions that try to cheat, break or outlive the grader, and the proof that none does."""
