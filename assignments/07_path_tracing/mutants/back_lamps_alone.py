"""The directions of the material have no derivative in it."""

TASKS = ("07.6",)
LOSES = ()
REPLACE = [
    (
        'counts[:n] &= found["thing"][:n] == lamp',
        ('counts[:n] &= found["thing"][:n] == lamp\n    counts[n:] = False'),
    ),
]
