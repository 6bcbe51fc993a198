"""Each texel has its neighbour's weight: the nearer texel must weigh more."""

TASKS = ("03.1",)
LOSES = ("03.1.centres", "03.1.ramp", "03.1.product", "03.1.edge", "03.1.hidden")
REPLACE = [
    (
        "s, t = (x - left)[:, None], (y - top)[:, None]",
        "s, t = 1 - (x - left)[:, None], 1 - (y - top)[:, None]",
    )
]
