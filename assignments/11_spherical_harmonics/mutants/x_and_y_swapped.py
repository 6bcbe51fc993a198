"""x and y have changed places: the angle runs from x to y."""

TASKS = ("11.1",)
LOSES = ("11.1.first", "11.1.signs", "11.1.hidden")
REPLACE = [
    (
        ("    even, odd, Q = _pieces(directions, degree)\n"),
        ("    even, odd, Q = _pieces(directions[:, [1, 0, 2]], degree)\n"),
    )
]
