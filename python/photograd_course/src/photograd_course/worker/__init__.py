"""The untrusted side: a small program that runs one submission, and the way to talk to it.

`__main__.py`, `codec.py`, `channel.py`, `modules.py` and `screen.py` run inside the worker and
import nothing of this package but one another; `process.py` is the grader's end.
"""
