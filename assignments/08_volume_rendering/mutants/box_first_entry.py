"""A ray is inside once it has entered on all three axes: take the last entry, not the first."""

TASKS = ("08.3",)
LOSES = ("08.3.axes", "08.3.faces", "08.3.parallel", "08.3.hidden")
REPLACE = [
    (
        "np.maximum(enter.max(axis=1), 0.0)",
        "np.maximum(np.where(parallel, 0.0, enter).min(axis=1), 0.0)",
    )
]
