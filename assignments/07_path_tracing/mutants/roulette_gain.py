"""q is not limited to 1: bright paths lose."""

TASKS = ("07.4",)
LOSES = (
    "07.4.ends",
    "07.4.hidden",
)
REPLACE = [
    (
        "q = np.minimum(1.0, beta.max(axis=1))",
        "q = beta.max(axis=1)",
    ),
]
