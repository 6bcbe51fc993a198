"""The derivative of the real wave by y is minus m times the imaginary one: the sign is missing."""

TASKS = ("11.3",)
LOSES = ("11.3.vectors", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("                slope[1] += common * (minus * even[m - 1] - plus * odd[m - 1])\n"),
        ("                slope[1] += common * (minus * even[m - 1] + plus * odd[m - 1])\n"),
    )
]
