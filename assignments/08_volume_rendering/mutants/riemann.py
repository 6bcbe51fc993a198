"""Your weight is T sigma dt: a step's opacity is 1 - exp(-sigma dt), never above 1."""

TASKS = ("08.1",)
LOSES = (
    "08.1.constant",
    "08.1.slabs",
    "08.1.weights",
    "08.1.split",
    "08.1.extremes",
    "08.1.order",
    "08.1.hidden",
)
REPLACE = [
    ("-np.expm1(-s)", "s"),
]
