"""The back of a lamp has a density, too; only its front is drawn to any use."""

TASKS = ("07.1",)
LOSES = ("07.1.none",)
REPLACE = [
    (
        "facing = -np.sum(wi[rows] * front_normals(scene)[lamp], axis=1)",
        "facing = np.abs(np.sum(wi[rows] * front_normals(scene)[lamp], axis=1))",
    )
]
