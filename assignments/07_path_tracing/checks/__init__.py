"""Public checks of assignment 07.

Most are exact: the numbers that a function would draw are arguments, and where they are nodes of a
quadrature their mean is an integral. Eleven judgements are of random draws. Where one is bad, at
2e-4, new draws get a second one: a right solution fails in less than one of a million submissions.
"""
