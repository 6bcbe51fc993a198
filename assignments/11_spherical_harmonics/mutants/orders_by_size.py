"""Your orders stand as 0, 1, -1, 2, -2, ...: they go from -l to l."""

TASKS = ("11.1",)
LOSES = ("11.1.first", "11.1.signs", "11.1.hidden")
REPLACE = [
    (
        ("            Y[:, ell * (ell + 1) - m] = _size(ell, m) * Q[ell, m] * odd[m]\n"),
        ("            Y[:, ell * ell + 2 * m] = _size(ell, m) * Q[ell, m] * odd[m]\n"),
    ),
    (
        ("            Y[:, ell * (ell + 1) + m] = _size(ell, m) * Q[ell, m] * even[m]\n"),
        ("            Y[:, ell * ell + max(2 * m - 1, 0)] = _size(ell, m) * Q[ell, m] * even[m]\n"),
    ),
]
