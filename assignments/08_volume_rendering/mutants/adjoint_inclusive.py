"""Your weights take the step's own extinction in T: backwards as forwards, T is that in front."""

TASKS = ("08.2",)
LOSES = (
    "08.2.differences",
    "08.2.background",
    "08.2.linear",
    "08.2.walls",
    "08.2.hidden",
    "08.2.cost",
)
REPLACE = [
    (
        "weight, after = T * -np.expm1(-tau), T * np.exp(-tau)",
        "weight, after = T * np.exp(-tau) * -np.expm1(-tau), T * np.exp(-tau)",
    )
]
