"""Public checks of assignment 07.

Most are exact: the random numbers of a function are arguments, and where they are nodes of a
quadrature their mean is an integral. Eleven tests use random samples. Where one fails, at 2e-4, a
second one has new samples: a right solution fails in less than one of a million submissions.
"""
