"""The farther of the two places is returned, where the ray leaves the sphere."""

TASKS = ("05.1",)
LOSES = ("05.1.outside", "05.1.misses", "05.1.hidden")
REPLACE = [
    ("t = np.where(nearest - half > T_MIN, nearest - half, nearest + half)", "t = nearest + half")
]
