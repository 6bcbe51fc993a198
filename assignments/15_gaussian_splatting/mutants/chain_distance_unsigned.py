"""You sort by depth backwards."""

TASKS = ("15.5",)
LOSES = ("15.5.one", "15.5.hidden")
REPLACE = [
    (
        'composite(alpha, part["colors"], depth, background)',
        'composite(alpha, part["colors"], -depth, background)',
    )
]
