"""Your V is the short form without roots: it is right at roughness 1 and 0 alone."""

TASKS = ("04.2",)
LOSES = ("04.2.energy", "04.2.hidden")
REPLACE = [
    (
        ("    L = stretched(o, alpha) * i[:, 2] + stretched(i, alpha) * o[:, 2]\n    lobe ="),
        (
            "    L = o[:, 2] * (i[:, 2] * (1 - alpha) + alpha) + i[:, 2] * (o[:, 2]"
            " * (1 - alpha) + alpha)\n"
            "    lobe ="
        ),
    )
]
