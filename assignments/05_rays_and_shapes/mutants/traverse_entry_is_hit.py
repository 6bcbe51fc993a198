"""t is where the ray enters the leaf's box, not where it meets the thing."""

TASKS = ("05.6",)
LOSES = ("05.6.nearest", "05.6.axes", "05.6.cost", "05.6.growth", "05.6.embree", "05.6.hidden")
REPLACE = [
    (
        "best, number = t.min(), things[t.argmin()]",
        "best, number = near + 1e-12, things[t.argmin()]",
    )
]
