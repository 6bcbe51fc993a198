"""A voxel at a border brings along voxels of the opposite border."""

TASKS = ("10.5",)
LOSES = ("10.5.grown", "10.5.hidden")
REPLACE = [
    ("moved = stays + np.array(away) - steps", "moved = (stays + np.array(away) - steps) % n")
]
