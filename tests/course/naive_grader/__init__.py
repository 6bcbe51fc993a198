"""A grader as it should not be, so that each attack can show that it works at all.

`program/` holds it: submissions run in the grader's own process, wrong answers within 1e-2 pass,
and a dozen other habits that are common and fatal. It never runs except through `cage.py`, which
keeps it, and the attacks on it, inside a scratch folder.
"""
