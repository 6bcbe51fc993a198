"""You take the nearest voxel: mix all eight."""

TASKS = ("08.4",)
LOSES = ("08.4.products", "08.4.hidden")
REPLACE = [
    (
        "share = np.prod(np.where(corner, f, 1 - f), axis=1)",
        "share = np.prod(np.where(corner, f >= 0.5, f < 0.5), axis=1)",
    )
]
