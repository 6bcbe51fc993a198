"""Your V pairs each stretched length with its own cosine: it is the other's."""

TASKS = ("04.2",)
LOSES = ("04.2.energy", "04.2.hidden")
REPLACE = [
    (
        ("    L = stretched(o, alpha) * i[:, 2] + stretched(i, alpha) * o[:, 2]\n    lobe ="),
        ("    L = stretched(o, alpha) * o[:, 2] + stretched(i, alpha) * i[:, 2]\n    lobe ="),
    )
]
