"""You count pixels column by column: they lie row by row, picture by picture."""

TASKS = ("09.2",)
LOSES = ("09.2.middle", "09.2.projected", "09.2.truth", "09.2.hidden")
REPLACE = [
    (
        "np.unravel_index(chosen, pictures.shape[:3])",
        'np.unravel_index(chosen, pictures.shape[:3], order="F")',
    )
]
