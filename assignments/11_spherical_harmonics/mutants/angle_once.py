"""Your waves turn once for each order: (x + i y) must be raised to the power m."""

TASKS = ("11.1",)
LOSES = ("11.1.addition", "11.1.gram", "11.1.signs", "11.1.hidden")
REPLACE = [
    (
        ("    even, odd, Q = _pieces(directions, degree)\n"),
        (
            "    even, odd, Q = _pieces(directions, degree)\n"
            "    even, odd = [even[min(m, 1)] for m in range(degree + 1)], [odd[min(m, 1)] "
            "for m in range(degree + 1)]\n"
        ),
    )
]
