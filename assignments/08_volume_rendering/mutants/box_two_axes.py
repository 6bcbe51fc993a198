"""A box has three axes: yours ignores z."""

TASKS = ("08.3",)
LOSES = ("08.3.axes", "08.3.faces", "08.3.inside", "08.3.parallel", "08.3.hidden")
REPLACE = [
    ("enter.max(axis=1)", "enter[:, :2].max(axis=1)"),
    ("leave.min(axis=1)", "leave[:, :2].min(axis=1)"),
]
