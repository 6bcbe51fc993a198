"""Next to nothing has no sign: rounding and hidden voxels have one with you."""

TASKS = ("09.5",)
LOSES = ("09.5.silent",)
REPLACE = [
    (
        "return np.where(np.abs(slope) > FLOOR * np.abs(slope).max(), np.sign(slope), 0.0)",
        "return np.sign(slope)",
    )
]
