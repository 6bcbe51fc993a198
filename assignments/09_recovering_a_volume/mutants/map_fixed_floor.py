"""Your floor is a fixed number: it is a share of the largest derivative."""

TASKS = ("09.5",)
LOSES = ("09.5.differences",)
REPLACE = [
    (
        "return np.where(np.abs(slope) > FLOOR * np.abs(slope).max(), np.sign(slope), 0.0)",
        "return np.where(np.abs(slope) > FLOOR, np.sign(slope), 0.0)",
    )
]
