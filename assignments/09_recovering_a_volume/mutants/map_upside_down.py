"""-1 means that descent raises sigma: your signs are those of the step, not of the derivative."""

TASKS = ("09.5",)
LOSES = ("09.5.differences", "09.5.hidden", "09.5.scene")
REPLACE = [
    (
        "return np.where(np.abs(slope) > FLOOR * np.abs(slope).max(), np.sign(slope), 0.0)",
        "return np.where(np.abs(slope) > FLOOR * np.abs(slope).max(), -np.sign(slope), 0.0)",
    )
]
