"""Your T takes the step's own extinction in: T is what is left in front of the step."""

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
REPLACE = [("np.exp(-front) *", "np.exp(-behind) *")]
