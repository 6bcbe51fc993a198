"""Against the axis a ray meets `high` first: sort the two crossings."""

TASKS = ("08.3",)
LOSES = ("08.3.axes", "08.3.faces", "08.3.inside", "08.3.hidden")
REPLACE = [
    (
        "enter, leave = np.minimum(first, second), np.maximum(first, second)",
        "enter, leave = first, second",
    )
]
