"""Helpers for the hidden checks of several tasks."""


def values(name):
    """The right values, without the `back` behind them."""
    return lambda reference, *args: getattr(reference, name)(*args)[0]


def derivatives(name):
    """What the right `back` makes of the last argument."""
    return lambda reference, *args: getattr(reference, name)(*args[:-1])[-1](args[-1])
