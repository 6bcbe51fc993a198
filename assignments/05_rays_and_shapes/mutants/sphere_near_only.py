"""A ray that starts inside meets nothing: the second place is never taken."""

TASKS = ("05.1",)
LOSES = ("05.1.inside", "05.1.misses", "05.1.hidden")
REPLACE = [
    ("t = np.where(nearest - half > T_MIN, nearest - half, nearest + half)", "t = nearest - half")
]
