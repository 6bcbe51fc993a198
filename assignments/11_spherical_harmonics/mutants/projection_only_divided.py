"""Your d_v is divided by the length, but still has a part along v."""

TASKS = ("11.3",)
LOSES = ("11.3.vectors", "11.3.length", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("    return d_coefficients, (slope.T - along[:, None] * d) / length[:, None]\n"),
        ("    return d_coefficients, slope.T / length[:, None]\n"),
    )
]
