"""Your weight is T sigma dt, with a T that takes the step itself in."""

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
REPLACE = [("w = np.exp(-front) * -np.expm1(-s)", "w = np.exp(-behind) * s")]
