"""Your columns of m and -m are exchanged, or x and y in equation (6)."""

TASKS = ("11.1",)
LOSES = ("11.1.first", "11.1.signs", "11.1.hidden")
REPLACE = [
    (
        ("    even, odd, Q = _pieces(directions, degree)\n"),
        ("    even, odd, Q = _pieces(directions[:, [1, 0, 2]], degree)\n"),
    )
]
