"""You sort the chosen pixels: answer in the order in which they came."""

TASKS = ("09.2",)
LOSES = ("09.2.middle", "09.2.projected", "09.2.truth", "09.2.hidden")
REPLACE = [
    (
        ('    pictures = views["pictures"]\n'),
        ('    pictures, chosen = views["pictures"], np.sort(chosen)\n'),
    )
]
