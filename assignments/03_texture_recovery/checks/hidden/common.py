"""Helpers for the hidden checks of several tasks."""


def sampled(t, n):
    """A texture and n points."""
    return t.rng.uniform(-1.0, 1.0, (3, 5, 2)), t.rng.uniform(-0.5, 1.5, (n, 2))


def measured(t, n):
    """A texture, n points and what was measured there."""
    return *sampled(t, n), t.rng.uniform(0.0, 1.0, (n, 2))
