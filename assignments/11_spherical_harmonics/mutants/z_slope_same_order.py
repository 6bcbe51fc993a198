"""The derivative of a polynomial by z is that of the next order."""

TASKS = ("11.3",)
LOSES = ("11.3.vectors", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        (
            "            slope[2] += _size(ell, m) * Q[ell, m + 1] * (plus * even[m] + "
            "minus * odd[m])\n"
        ),
        ("            slope[2] += _size(ell, m) * Q[ell, m] * (plus * even[m] + minus * odd[m])\n"),
    )
]
