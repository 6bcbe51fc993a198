"""You average the upper half with the lower half: neighbours belong together."""

TASKS = ("03.6",)
LOSES = ("03.6.spot", "03.6.hidden")
REPLACE = [
    ("(fine[0::2] + fine[1::2]) / 2", "(fine[: len(fine) // 2] + fine[len(fine) // 2 :]) / 2")
]
