"""Samples are not divided by their density."""

TASKS = ("07.3",)
LOSES = ("07.3.furnace", "07.3.hidden", "07.3.matte", "07.3.proposal")
REPLACE = [
    (
        "scale = np.divide(scale, mine, out=np.zeros(len(mine)), where=lit)",
        "scale = np.where(lit, scale, 0.0)",
    )
]
