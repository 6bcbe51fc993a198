"""You add texels without dividing: each level is brighter than the one before."""

TASKS = ("03.6",)
LOSES = ("03.6.mean", "03.6.spot", "03.6.hidden")
REPLACE = [
    ("(fine[0::2] + fine[1::2]) / 2", "fine[0::2] + fine[1::2]"),
    ("(fine[:, 0::2] + fine[:, 1::2]) / 2", "fine[:, 0::2] + fine[:, 1::2]"),
]
