"""A lower limit for q keeps black paths alive."""

TASKS = ("07.4",)
LOSES = (
    "07.4.ends",
    "07.4.hidden",
)
REPLACE = [
    (
        "q = np.minimum(1.0, beta.max(axis=1))",
        "q = np.clip(beta.max(axis=1), 0.05, 1.0)",
    ),
]
