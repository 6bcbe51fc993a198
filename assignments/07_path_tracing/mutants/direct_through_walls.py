"""Another lamp before the one that was drawn is counted in its place."""

TASKS = ("07.3",)
LOSES = ("07.3.hidden",)
REPLACE = [
    (
        ('lit &= there["thing"] == wanted\n            mine, theirs = by_light, by_surface'),
        "mine, theirs = by_light, by_surface",
    ),
]
