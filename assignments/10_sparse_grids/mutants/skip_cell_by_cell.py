"""The jump ends at the face of the cell, not of the leaf: large leaves save nothing."""

TASKS = ("10.2",)
LOSES = ("10.2.cost",)
REPLACE = [
    (
        "face = low + np.where(step > 0, side[:, None], 0.0)",
        "face = np.floor(here) + np.where(step > 0, 1.0, 0.0)",
    )
]
