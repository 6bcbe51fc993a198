"""Backs of lamps have a density, fronts none: wi leads to the lamp, its normal away from it."""

TASKS = ("07.1",)
LOSES = ("07.1.hidden", "07.1.none", "07.1.solid_angle", "07.1.straight")
REPLACE = [
    (
        "facing = -np.sum(wi[rows] * front_normals(scene)[lamp], axis=1)",
        "facing = np.sum(wi[rows] * front_normals(scene)[lamp], axis=1)",
    )
]
