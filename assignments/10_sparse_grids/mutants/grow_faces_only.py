"""A voxel brings along neighbours across faces only; samples read corners as well."""

TASKS = ("10.5",)
LOSES = ("10.5.grown", "10.5.render", "10.5.hidden")
REPLACE = [
    (
        "active[tuple(moved[inside].T)] = True",
        "active[tuple(moved[inside].T)] |= sum(abs(a - steps) for a in away) <= steps",
    )
]
