"""There is no root in your roughness: edges cost their square."""

TASKS = ("09.4",)
LOSES = ("09.4.values", "09.4.hidden")
REPLACE = [
    (
        "length = np.sqrt(eps**2 + np.sum(ahead**2, axis=0))",
        "length = 0.5 * (1 + np.sum(ahead**2, axis=0))",
    ),
    ("np.sum(length - eps)", "np.sum(length - 0.5)"),
    ("ahead / length / count", "ahead / count"),
]
