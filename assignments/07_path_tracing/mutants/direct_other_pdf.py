"""A sample is divided by the density of the other strategy."""

TASKS = ("07.3",)
LOSES = ("07.3.furnace", "07.3.hidden", "07.3.matte", "07.3.proposal")
REPLACE = [
    (
        "scale = np.divide(scale, mine, out=np.zeros(len(mine)), where=lit)",
        ("scale = np.divide(scale, theirs, out=np.zeros(len(mine)), where=lit & (theirs > 0))"),
    )
]
