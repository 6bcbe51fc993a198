"""Large densities are squared before they are divided, and become infinite."""

TASKS = ("07.2",)
LOSES = ("07.2.extremes",)
REPLACE = [
    (
        "return np.where(pdf > 0, mine / np.where(pdf > 0, mine + theirs, 1.0), 0.0)",
        ('with np.errstate(all="ignore"):\n        return np.nan_to_num(mine / (mine + theirs))'),
    ),
]
