"""A longer focal length narrows the view: divide by it."""

TASKS = ("09.2",)
LOSES = ("09.2.projected", "09.2.hidden")
REPLACE = [
    ("pictures.shape[2] / 2) /", "pictures.shape[2] / 2) *"),
    ("pictures.shape[1] / 2) /", "pictures.shape[1] / 2) *"),
]
