"""Voxel 0 exists: only row -1 means that there is none."""

TASKS = ("10.4",)
LOSES = ("10.4.transpose", "10.4.picture", "10.4.hidden")
REPLACE = [("known = row >= 0", "known = row > 0")]
