"""Your quadrature is not exact: function times harmonic has twice the degree."""

TASKS = ("11.4",)
LOSES = ("11.4.turns", "11.4.compose", "11.4.hidden")
REPLACE = [
    (
        ("    directions, weights = quadrature(2 * degree)\n    before"),
        ("    directions, weights = quadrature(degree)\n    before"),
    )
]
