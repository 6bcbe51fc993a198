"""You blend over black."""

TASKS = ("15.5",)
LOSES = ("15.5.one", "15.5.differences", "15.5.behind", "15.5.hidden")
REPLACE = [
    (
        'composite(alpha, part["colors"], depth, background)',
        'composite(alpha, part["colors"], depth, 0 * background)',
    )
]
