"""Your pole lies along y: equations (6) and (7) take z for the pole."""

TASKS = ("11.1",)
LOSES = ("11.1.first", "11.1.signs", "11.1.hidden")
REPLACE = [
    (
        ("    even, odd, Q = _pieces(directions, degree)\n"),
        ("    even, odd, Q = _pieces(directions[:, [2, 0, 1]], degree)\n"),
    )
]
