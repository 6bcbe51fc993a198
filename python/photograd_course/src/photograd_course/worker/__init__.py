"""The untrusted side: a small program that runs one submission, and the way to talk to it.

The modules `__main__`, `codec`, `channel`, `modules` and `screen` run inside the worker and import
nothing of this package but one another; `process` is the grader's end.
"""
