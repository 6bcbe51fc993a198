"""Public checks of assignment 04.

Seven sets of random samples are judged. Where a judgement is bad, at 3e-4, new samples get a second
one: a right solution fails in less than one of a million submissions.
"""
