"""Your blocks are shifted by one texel: rows 2 i and 2 i + 1 become row i."""

TASKS = ("03.6",)
LOSES = ("03.6.spot", "03.6.hidden")
REPLACE = [
    (
        "(fine[0::2] + fine[1::2]) / 2",
        "(np.roll(fine, -1, axis=0)[0::2] + np.roll(fine, -1, axis=0)[1::2]) / 2",
    )
]
