"""The directions of the material have no derivative in it."""

TASKS = ("07.6",)
LOSES = ("07.6.cost", "07.6.differences", "07.6.hidden", "07.6.mean")
REPLACE = [
    (
        'counts[:n] &= found["thing"][:n] == lamp',
        ('counts[:n] &= found["thing"][:n] == lamp\n    counts[n:] = False'),
    )
]
