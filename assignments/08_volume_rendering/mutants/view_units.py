"""Your steps are in units of the direction's length, not in metres: use ray_samples' dt."""

TASKS = ("08.6",)
LOSES = ("08.6.differences", "08.6.hidden")
REPLACE = [
    (
        "found = trilinear(grid, flat)",
        (
            "lengths = lengths / np.linalg.norm(directions, axis=1)[:, None]\n"
            "    found = trilinear(grid, flat)"
        ),
    )
]
