"""Your masking and shadowing are independent: a facet deep down is hidden from both sides."""

TASKS = ("04.2",)
LOSES = ("04.2.ball", "04.2.energy", "04.2.hidden")
REPLACE = [
    (
        ("    L = stretched(o, alpha) * i[:, 2] + stretched(i, alpha) * o[:, 2]\n    lobe ="),
        (
            "    L = (stretched(o, alpha) + o[:, 2]) * (stretched(i, alpha) + i[:,"
            " 2]) / 2\n"
            "    lobe ="
        ),
    )
]
