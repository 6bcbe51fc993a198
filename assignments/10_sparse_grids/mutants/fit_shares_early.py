"""The shares are those before the last step; take those of the newest values."""

TASKS = ("10.6",)
LOSES = ("10.6.chain", "10.6.hidden")
REPLACE = [
    ("adam = Adam()", "adam, before = Adam(), values"),
    (
        "values = adam.step(values, d_values)",
        "before, values = values, adam.step(values, d_values)",
    ),
    ("*shares(values, samples)", "*shares(before, samples)"),
]
