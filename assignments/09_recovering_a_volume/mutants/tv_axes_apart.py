"""You take a root for each axis: the three differences of a voxel stand under one."""

TASKS = ("09.4",)
LOSES = ("09.4.values", "09.4.hidden")
REPLACE = [
    ("length = np.sqrt(eps**2 + np.sum(ahead**2, axis=0))", "length = np.sqrt(eps**2 + ahead**2)")
]
