"""Your harmonics belong to -d: the odd degrees have the other sign."""

TASKS = ("11.1",)
LOSES = ("11.1.first", "11.1.signs", "11.1.hidden")
REPLACE = [
    (
        ("    even, odd, Q = _pieces(directions, degree)\n"),
        ("    even, odd, Q = _pieces(-directions, degree)\n"),
    )
]
