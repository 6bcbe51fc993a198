"""The neighbours are there, the voxel itself is not."""

TASKS = ("10.5",)
LOSES = ("10.5.grown", "10.5.hidden")
REPLACE = [
    (
        "active[tuple(moved[inside].T)] = True",
        "active[tuple(moved[inside].T)] |= not steps or set(away) != {steps}",
    )
]
