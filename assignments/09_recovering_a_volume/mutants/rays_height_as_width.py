"""H counts rows, W columns: yours are exchanged."""

TASKS = ("09.2",)
LOSES = ("09.2.middle", "09.2.projected", "09.2.hidden")
REPLACE = [
    ("right = (col + 0.5 - pictures.shape[2] / 2)", "right = (col + 0.5 - pictures.shape[1] / 2)"),
    ("down = (row + 0.5 - pictures.shape[1] / 2)", "down = (row + 0.5 - pictures.shape[2] / 2)"),
]
