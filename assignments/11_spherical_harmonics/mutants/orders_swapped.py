"""Your columns of m and -m are exchanged, or x and y in equation (6)."""

TASKS = ("11.1",)
LOSES = ("11.1.first", "11.1.signs", "11.1.hidden")
REPLACE = [
    (
        ("            Y[:, ell * (ell + 1) - m] = _size(ell, m) * Q[ell, m] * odd[m]\n"),
        ("            Y[:, ell * (ell + 1) - m] = _size(ell, m) * Q[ell, m] * even[m]\n"),
    ),
    (
        ("            Y[:, ell * (ell + 1) + m] = _size(ell, m) * Q[ell, m] * even[m]\n"),
        (
            "            if m > 0:\n"
            "                Y[:, ell * (ell + 1) + m] = _size(ell, m) * Q[ell, m] * "
            "odd[m]\n"
        ),
    ),
]
