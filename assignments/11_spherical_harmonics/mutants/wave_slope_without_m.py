"""The factor m is missing from the derivative of the waves."""

TASKS = ("11.3",)
LOSES = ("11.3.vectors", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("                common = _size(ell, m) * m * Q[ell, m]\n"),
        ("                common = _size(ell, m) * Q[ell, m]\n"),
    )
]
