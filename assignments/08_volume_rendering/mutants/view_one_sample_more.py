"""Backwards you take another number of samples than forwards."""

TASKS = ("08.6",)
LOSES = ("08.6.differences", "08.6.hidden")
REPLACE = [
    (
        ("ray_samples(low, high, origins, directions, n)\n    flat"),
        ("ray_samples(low, high, origins, directions, n + 1)\n    flat"),
    )
]
