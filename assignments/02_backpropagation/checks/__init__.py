"""Public checks of assignment 02.

Values and local derivatives of gates are tested separately, so that a mistake there does not count
against `backward`; graphs made by hand, with a given order, do the same for `backward`.
"""
