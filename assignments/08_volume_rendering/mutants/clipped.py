"""Your opacity is sigma dt, clipped or not: it is 1 - exp(-sigma dt), which never passes 1."""

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
REPLACE = [("-np.expm1(-s)", "np.minimum(s, 1)")]
