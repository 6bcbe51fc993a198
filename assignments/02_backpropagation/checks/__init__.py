"""Public checks of assignment 02.

A gate is asked for its value and for the slopes that it noted, so that a mistake there does not
count against `backward`; graphs made by hand, with their order given, do the same for `backward`.
"""
