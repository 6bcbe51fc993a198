"""Public checks of assignment 04.

Seven sets of random draws are judged. Where a judgement is bad, at 3e-4, new draws get a second
one: a right solution fails in less than one of a million submissions.
"""
