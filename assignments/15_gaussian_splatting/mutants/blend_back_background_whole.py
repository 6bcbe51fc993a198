"""The background counts as much as is left of T."""

TASKS = ("15.4",)
LOSES = ("15.4.differences", "15.4.hidden")
REPLACE = [
    ("return d_alpha, d_colors, T[-1] @ d_shown", "return d_alpha, d_colors, d_shown.sum(axis=0)")
]
